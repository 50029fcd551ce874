//! Codes that controls share: ISO 6983's own, and those of the dialects that follow RS-274.

use super::codes::{CycleKind, G, M, Mode};
use crate::geom::Side;
use crate::readback::FeedMode;
use crate::readback::curve::Plane;

/// G codes that mean the same on every control of the family, in tenths.
pub(super) fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        0 => G::Motion(Mode::Rapid),
        10 => G::Motion(Mode::Linear),
        20 | 30 => G::Motion(Mode::Arc { clockwise: tenths == 20 }),
        40 => G::Dwell,
        170 => G::Plane(Plane::Xy),
        180 => G::Plane(Plane::Zx),
        190 => G::Plane(Plane::Yz),
        530 => G::MachineCoordinates,
        900 | 910 => G::Distance { incremental: tenths == 910 },
        _ => return None,
    })
}

/// [`g`] with the codes of controls that descend from RS-274: units, reference, compensation off, feed modes, offsets.
pub(super) fn rs274(tenths: u16) -> Option<G> {
    Some(match tenths {
        200 | 210 => G::Units { inch: tenths == 200 },
        280 | 300 => G::Reference,
        400 => G::RadiusOff,
        490 => G::LengthOff,
        610 => G::ExactPath,
        800 => G::Motion(Mode::None),
        930 => G::Feed(FeedMode::InverseTime),
        940 => G::Feed(FeedMode::PerMinute),
        _ => return g(tenths).or_else(|| offset(tenths)),
    })
}

/// G41, G42.
pub(super) fn radius(tenths: u16) -> Option<G> {
    let side = if tenths == 410 { Side::Left } else { Side::Right };
    matches!(tenths, 410 | 420).then_some(G::Radius { side })
}

/// G54 to G59, by number from 1.
pub(super) fn offset(tenths: u16) -> Option<G> {
    (matches!(tenths, 540..=590) && tenths.is_multiple_of(10)).then(|| G::WorkOffset((tenths - 530) / 10))
}

/// The drilling cycles that most controls share.
pub(super) fn cycle(tenths: u16) -> Option<G> {
    Some(G::Motion(Mode::Cycle(match tenths {
        730 => CycleKind::ChipBreak,
        740 => CycleKind::Tap { left: true },
        760 => CycleKind::Fine,
        810 => CycleKind::Drill,
        820 => CycleKind::Dwell,
        830 => CycleKind::Deep,
        840 => CycleKind::Tap { left: false },
        850 => CycleKind::Bore,
        860 => CycleKind::BoreStop,
        890 => CycleKind::BoreDwell,
        _ => return None,
    })))
}

/// M codes that mean the same on every control that ends a program by M2 or M30.
pub(super) fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        0 => M::Stop { optional: false },
        10 => M::Stop { optional: true },
        20 | 300 => M::End,
        30 => M::SpindleOn { clockwise: true },
        40 => M::SpindleOn { clockwise: false },
        50 => M::SpindleOff,
        70 | 80 => M::CoolantOn { mist: tenths == 70 },
        90 => M::CoolantOff,
        _ => return None,
    })
}

/// The radii of an arc's start and end may differ by 0.5 mm, or by 0.005 mm and 0.1 % of the radius (LinuxCNC, Grbl).
pub(super) fn radius_difference(radius: f64, _inch: bool) -> f64 {
    (0.001 * radius).clamp(0.005, 0.5)
}
