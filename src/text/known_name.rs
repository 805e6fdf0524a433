//! Advice on unknown names that are known ones in letters of another alphabet, or in another unit.

use super::scalar::latin;

/// Last parts of names that are units.
const UNITS: [&str; 36] = [
    "s", "ms", "us", "ns", "min", "h", "a", "ma", "ua", "na", "v", "mv", "uv", "deg", "rad", "mrad", "urad", "arcsec",
    "arcmin", "gon", "ppm", "percent", "mm", "cm", "m", "km", "ft", "s2", "g", "g2", "gal", "mgal", "c", "k", "f",
    "mas",
];

/// Returns the advice for an unknown name that only looks like one of the `known`, is one of them in another unit, whose
/// numbers must be converted, or is an expanded uncertainty instead of a standard one; `None` for other names.
pub(super) fn advice(known: &[&str], found: &str) -> Option<String> {
    if let Some((latin, odd)) = latin(found).filter(|(latin, _)| known.contains(&latin.as_str())) {
        return Some(format!("the {odd} only looks like a Latin letter; type {latin} again"));
    }
    if let Some(name) = known.iter().find(|name| found.starts_with("U_") && **name == found.to_lowercase()) {
        return Some(format!(
            "if U is an expanded uncertainty, divide the numbers by its coverage factor k; then name it {name}"
        ));
    }
    let found = found.to_lowercase();
    let (quantity, unit) = split(&found)?;
    let (name, known) = known.iter().find_map(|name| {
        let (of, known) = split(name)?;
        (of == quantity && known != unit).then_some((name, known))
    })?;
    let words = |unit: &str| unit.replace('_', " ");
    Some(format!("convert the numbers from {} to {}, then name it {name}", words(unit), words(known)))
}

/// Returns the quantity and the unit of a name such as `alpha_arcsec` or `k_x_deg_per_h_per_ma`; `None` if it states no unit.
fn split(name: &str) -> Option<(&str, &str)> {
    let is_unit = |(_, unit): &(&str, &str)| UNITS.contains(unit);
    let (mut quantity, _) = name.rsplit_once('_').filter(is_unit)?;
    while let Some((stem, _)) = quantity.strip_suffix("_per").and_then(|name| name.rsplit_once('_')).filter(is_unit) {
        quantity = stem;
    }
    Some((quantity, &name[quantity.len() + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: the units by hand; GUM 2.3.5 and 6.2.1 for U = k u.
    #[test]
    fn another_unit_is_to_be_converted() {
        let known = [
            "alpha_arcsec",
            "u_arcsec",
            "u_alpha_arcsec",
            "jx_ma",
            "time_s",
            "gravity_m_per_s2",
            "height_m",
            "omega_g_deg_per_h_per_g",
        ];
        for (found, from, to, name) in [
            ("alpha_arcmin", "arcmin", "arcsec", "alpha_arcsec"),
            ("alpha_deg", "deg", "arcsec", "alpha_arcsec"),
            ("alpha_mrad", "mrad", "arcsec", "alpha_arcsec"),
            ("u_arcmin", "arcmin", "arcsec", "u_arcsec"),
            ("jx_uA", "ua", "ma", "jx_ma"),
            ("jx_A", "a", "ma", "jx_ma"),
            ("time_ms", "ms", "s", "time_s"),
            ("gravity_mGal", "mgal", "m per s2", "gravity_m_per_s2"),
            ("height_km", "km", "m", "height_m"),
            ("omega_g_rad_per_s_per_g", "rad per s per g", "deg per h per g", "omega_g_deg_per_h_per_g"),
        ] {
            let due = format!("convert the numbers from {from} to {to}, then name it {name}");
            assert_eq!(advice(&known, found), Some(due), "{found}");
        }
        for name in ["u_arcsec", "u_alpha_arcsec"] {
            let said = advice(&known, &name.replacen('u', "U", 1)).unwrap();
            assert!(said.contains("divide") && said.ends_with(name), "{said}");
        }
        for other in ["alpha_arcsecs", "alfa_arcsec", "alpha", "jx_mA", "time_of_day", "omega_k_deg_per_h_per_g", "k"] {
            assert_eq!(advice(&known, other), None, "{other}");
        }
    }
}
