//! The controls of the family, one row each.

use super::rules::Rules;

mod centroid;
pub(super) mod fanuc;
mod grbl;
mod grblhal;
mod haas;
mod linuxcnc;
mod mach3;
mod marlin;
mod mazak;
mod mitsubishi;
mod okuma;

/// Every control of the word-address family.
pub(in crate::readback) const CONTROLS: [&Rules; 15] = [
    &linuxcnc::RULES,
    &fanuc::RULES,
    &haas::RULES,
    &mazak::RULES,
    &mitsubishi::RULES,
    &okuma::RULES,
    &centroid::RULES,
    &mach3::RULES,
    &mach3::MILLISECONDS,
    &grbl::RULES,
    &grblhal::RULES,
    &marlin::RULES,
    &marlin::SMOOTHIEWARE,
    &marlin::SMOOTHIEWARE_GRBL,
    &super::sinumerik::RULES,
];
