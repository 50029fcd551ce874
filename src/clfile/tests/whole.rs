//! What is said of a file as a whole: its unit, whether it is all there.

use super::{Options, Producer, Reader, framed, kinds};
use crate::source::FileId;
use crate::units::LengthUnit;

/// The unit found, and whether it is said to be assumed.
fn unit(text: &str, defines: &[(&str, &str)]) -> (LengthUnit, bool) {
    let defines = defines.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let options = Options { defines, ..Options::default() };
    let (cl, sink) = Reader::new(FileId(0), "part.cl", text, &options).whole();
    (cl.units, sink.into_items().iter().any(|d| d.code.id == "W1017"))
}

fn with(head: &str) -> String {
    format!("{head}\nLOADTL/1\nSPINDL/100,RPM\nFEDRAT/5\nRAPID\nGOTO/1,0,0\nGOTO/2,0,0\n")
}

#[test]
fn the_unit_is_found_however_it_is_written() {
    for head in
        ["UNITS/INCHES", "UNITS / INCHES", "units  /   inch", "UNIT/IN", "N1 , UNITS/INCHES", "FEDRAT/5,IPM"]
    {
        assert_eq!(unit(&with(head), &[]), (LengthUnit::Inch, false), "{head}");
    }
    for head in ["UNITS  /  MM", "UNIT/MM", "FEDRAT/ MMPM, 5", "CYCLE/DRILL,5,5,MMPM,2\nCYCLE/OFF"] {
        assert_eq!(unit(&with(head), &[]), (LengthUnit::Millimetre, false), "{head}");
    }
    let carriage_returns = with("UNITS/INCHES").replace('\n', "\r");
    assert_eq!(unit(&carriage_returns, &[]), (LengthUnit::Inch, false));
}

#[test]
fn a_unit_that_is_assumed_is_said_to_be() {
    assert_eq!(unit(&with("$$ no unit"), &[]), (LengthUnit::Millimetre, true));
    assert_eq!(unit(&with("$$ no unit"), &[("UNITS", "INCH")]), (LengthUnit::Inch, false));
    assert_eq!(unit(&with("$$ no unit"), &[("units", "mm")]), (LengthUnit::Millimetre, false));
}

/// Whether a file is said to stop without its end.
fn cut_off(text: &str, producer: Producer) -> bool {
    let options = Options { producer: Some(producer), ..Options::default() };
    let (_, sink) = Reader::new(FileId(0), "part.cl", text, &options).whole();
    sink.into_items().iter().any(|d| d.code.id == "W1019")
}

#[test]
fn a_file_that_stops_without_its_end_is_said_to() {
    let whole = framed("GOTO/20,0,0");
    let cut = whole.replace("FINI\n", "");
    for producer in [Producer::Creo, Producer::Catia, Producer::SolidWorks, Producer::Ncl] {
        assert!(!cut_off(&whole, producer) && cut_off(&cut, producer), "{producer:?}");
    }
    assert!(!cut_off(&cut, Producer::Plain));
    let path =
        "TOOL PATH/P,TOOL,T\nLOAD/TOOL,1\nSPINDL/RPM,100,CLW\nFEDRAT/MMPM,5\nRAPID\nGOTO/0,0,9\nGOTO/1,0,0\n";
    let nx = format!("{path}END-OF-PATH\n");
    assert!(!cut_off(&nx, Producer::Nx) && cut_off(path, Producer::Nx));
    assert!(cut_off(&format!("{nx}{path}"), Producer::Nx));
    let nci = "1001\n0 1 1 6 6 6 0 2000. 300. 1\n0\n0 20. 0. 5. -2. 0\n1\n0 20. 0. -1. 150. 0\n1003\n";
    assert!(cut_off(nci, Producer::Mastercam) && !cut_off(&format!("{nci}0\n"), Producer::Mastercam));
}

#[test]
fn numbers_of_cards_are_no_part_of_the_record() {
    let card = |text: &str, number: u32| format!("{text:<72}{number:08}\n");
    let lines = framed("GOTO/20,$\n0,0");
    let cards: String = lines.lines().zip(1..).map(|(line, n)| card(line, n)).collect();
    let read = |card_columns| {
        let options = Options { card_columns, ..Options::default() };
        let (cl, sink) = Reader::new(FileId(0), "part.cl", &cards, &options).whole();
        (kinds(&cl), sink.into_items().len())
    };
    assert_eq!(read(true), ("RL".to_owned(), 0));
    assert!(read(false).1 > 0);
}
