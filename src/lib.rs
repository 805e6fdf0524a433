//! x
pub mod attitude;
pub mod bibliography;
pub mod calibration;
pub mod coefficients;
pub mod earth;
pub mod gyro;
pub mod site;
pub mod stand;
pub mod text;
pub mod units;
