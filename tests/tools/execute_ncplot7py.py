"""Executes a program with ncplot7py and prints its motion.

usage: execute_ncplot7py.py MACHINE FILE      (MACHINE: FANUC_MILL, SIEMENS_840DI)

One line for every motion: M, line of the program, R (rapid) or F (feed), seconds, then points x y z on the path, its ends
included, in the program's unit. Exit status 1 when ncplot7py refuses the program.

What it can't see, and what is therefore taken out of the text before (the lines stay):
- H words: they move its C axis; so G43 and the retract by G28 are not executed by it either;
- G67 and G64 in one block: it takes them for codes of one group;
- CYCLE832, G06.2 and the like: unknown. Cycles of the Fanuc form are not worked off in the way of a milling machine.
"""

import re
import sys

from ncplot7py.application.nc_execution import NCExecutionEngine
from ncplot7py.domain.cnc_state import CNCState
from ncplot7py.domain.machines import get_machine_config
from ncplot7py.infrastructure.machines.base_stateful_control import UniversalConfigDrivenControl
from ncplot7py.shared import configure_logging

SAMPLES = 8


def readable(line, machine):
    if line.lstrip().startswith("(") or line.lstrip().startswith(";"):
        return line
    if machine == "FANUC_MILL":
        return re.sub(r"\b(G43|G49|H\d+|G67)\b *", "", line)
    return re.sub(r"CYCLE832\([^)]*\)", "", line)


def main():
    machine, name = sys.argv[1:]
    configure_logging(console=False, web_buffer=False)
    with open(name, encoding="ascii") as file:
        text = "\n".join(readable(line, machine) for line in file.read().split("\n"))
    state = CNCState()
    state.machine_config = get_machine_config(machine)
    engine = NCExecutionEngine(UniversalConfigDrivenControl(1, init_nc_states=[state]))
    canals = engine.get_Syncro_plot([text])
    if engine.errors or not canals or not isinstance(canals[0], dict):
        print(engine.errors, file=sys.stderr)
        return 1
    for motion in canals[0]["plot"]:
        points = list(zip(motion["x"], motion["y"], motion["z"]))
        if len(points) < 2 or motion["traversal"] not in ("RAPID", "FEED"):
            continue
        last = len(points) - 1
        chosen = sorted({round(i * last / SAMPLES) for i in range(SAMPLES + 1)})
        numbers = " ".join(f"{value:.9f}" for i in chosen for value in points[i])
        print("M", motion["lineNumber"], motion["traversal"][0], f"{motion['t']:.9f}", numbers)
    return 0


if __name__ == "__main__":
    sys.exit(main())
