"""Executes a SINUMERIK program with nc-gcode-interpreter and prints where each block ends.

usage: execute_nc_gcode_interpreter.py FILE

One line for every block that has a motion code and a known position: P, line, motion code, x y z in the program's unit.
Exit status 1 when the program is refused.

It parses strictly and keeps modal state. It sees no arcs (their ends only), works off no cycles, does not change units
and takes the F of a dwell for a feed.
"""

import sys

from nc_gcode_interpreter import nc_to_dataframe


def main():
    with open(sys.argv[1], encoding="ascii") as file:
        # Blank lines would be dropped, and the count of lines with them.
        lines = [line if line.strip() else "; -" for line in file.read().rstrip("\n").split("\n")]
    try:
        frame, _ = nc_to_dataframe("\n".join(lines) + "\n")
    except Exception as error:
        print(error, file=sys.stderr)
        return 1
    if len(frame) != len(lines):
        print(f"{len(frame)} rows for {len(lines)} lines", file=sys.stderr)
        return 1
    for number, row in enumerate(frame.iter_rows(named=True), start=1):
        place = [row.get(axis) for axis in "XYZ"]
        motion = row.get("gg01_motion")
        if motion and None not in place:
            print("P", number, motion, *(f"{value:.9f}" for value in place))
    return 0


if __name__ == "__main__":
    sys.exit(main())
