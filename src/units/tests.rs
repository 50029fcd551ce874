use super::*;
use proptest::prelude::*;

#[test]
fn compound_units_are_read() {
    let unit = |text| parse_unit(text).map(|u| (u.factor, u.dim));
    assert_eq!(unit("mm/min"), Some((1.0 / 60.0, Dim::FEED)));
    assert_eq!(unit("N/mm2"), Some((1.0, Dim::STRESS)));
    assert_eq!(unit("N/mm^2"), Some((1.0, Dim::STRESS)));
    assert_eq!(unit("in/min"), Some((25.4 / 60.0, Dim::FEED)));
    assert_eq!(unit("RPM"), Some((1.0 / 60.0, Dim::SPEED)));
    assert_eq!(unit("furlong"), None);
    assert_eq!(unit("mm/"), None);
    assert_eq!(unit(""), None);
}

#[test]
fn a_bare_number_takes_the_dimension_of_its_place() {
    let feed =
        Quantity::bare(300.0).land(Dim::FEED, LengthUnit::Millimetre).expect("a bare number fits anywhere");
    assert_eq!(feed.value, 5.0);
    assert_eq!(feed.show(LengthUnit::Millimetre), "300 mm/min");
    let inch = Quantity::bare(1.1).land(Dim::LENGTH, LengthUnit::Inch).expect("a bare number fits anywhere");
    assert_eq!(inch.value, 27.94);
    assert_eq!(Quantity::new(1.0, Dim::ANGLE).land(Dim::LENGTH, LengthUnit::Inch), None);
}

#[test]
fn conversions_leave_no_noise() {
    for rpm in [800.0, 1200.0, 333.0, 7.0] {
        let speed =
            Quantity::bare(rpm).land(Dim::SPEED, LengthUnit::Inch).expect("a bare number fits anywhere");
        assert_eq!(tidy(speed.value * 60.0), rpm);
        assert_eq!(speed.in_unit(LengthUnit::Inch), rpm);
    }
    for thousandths in 0..3000 {
        let inch = f64::from(thousandths) / 1000.0;
        let mm: f64 = format!("{:.4}", f64::from(thousandths) * 0.0254).parse().expect("a number");
        let landed =
            Quantity::bare(inch).land(Dim::LENGTH, LengthUnit::Inch).expect("a bare number fits anywhere");
        assert_eq!(landed.value, mm);
    }
}

#[test]
fn dimensions_have_names_and_symbols() {
    assert_eq!(Dim::AREA.symbol(LengthUnit::Inch), "in^2");
    assert_eq!(Dim::FEED.symbol(LengthUnit::Inch), "in/min");
    assert_eq!(Dim { length: -1, ..Dim::NONE }.symbol(LengthUnit::Millimetre), "1/mm");
    assert_eq!(Dim::SPEED.name(), "spindle speed");
    assert_eq!(Dim { length: 4, ..Dim::NONE }.name(), "quantity in mm^4");
    assert_eq!(Dim::AREA.power(1, 2), Some(Dim::LENGTH));
    assert_eq!(Dim::LENGTH.power(1, 2), None);
}

#[test]
fn numbers_in_messages_have_no_noise() {
    assert_eq!(number(-0.0), "0");
    assert_eq!(number(24.577_835_123), "24.577835");
    assert_eq!(number(30.0), "30");
    assert_eq!(number(1e-5), "1e-5");
    assert_eq!(number(1.25e15), "1.25e15");
}

fn any_dim() -> impl Strategy<Value = Dim> {
    (-3i8..4, -1i8..2, -1i8..2, -1i8..2, -1i8..2, -1i8..2).prop_map(
        |(length, angle, time, force, revolution, tooth)| Dim {
            length,
            angle,
            time,
            force,
            revolution,
            tooth,
        },
    )
}

proptest! {
    #[test]
    fn what_is_printed_reads_back(value in -1e6f64..1e6, dim in any_dim(), inch in any::<bool>()) {
        let unit = if inch { LengthUnit::Inch } else { LengthUnit::Millimetre };
        let printed = Quantity::new(value, dim).exact(unit);
        let split = printed.find(|c: char| c.is_ascii_alphabetic() || c == '/').unwrap_or(printed.len());
        let (digits, symbol) = if dim.symbol(unit).starts_with("1/") {
            printed.split_at(printed.len() - dim.symbol(unit).len())
        } else {
            printed.split_at(split)
        };
        let read = if symbol.is_empty() {
            Quantity::bare(digits.parse().expect("a number"))
        } else {
            Quantity::of(digits.parse().expect("a number"), parse_unit(symbol).expect("a unit"))
        };
        prop_assert_eq!(read.dim, dim);
        prop_assert!((read.value - value).abs() <= 1e-13 * value.abs());
    }

    #[test]
    fn product_and_quotient_undo_each_other(a in any_dim(), b in any_dim()) {
        prop_assert_eq!(a.times(b).and_then(|c| c.over(b)), Some(a));
    }
}
