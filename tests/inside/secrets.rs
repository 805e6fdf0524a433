//! Words of files that may be secrets, as messages show them.

use crate::text::without_secrets;

/// Expected: RFC 4648 and BIP 173 for the forms; no more than 8 characters remain of any.
#[test]
fn of_a_secret_the_beginning_remains() {
    let base64 = "LXEWQrcmsEQBYnyp+6wy9chTD7GQPMTbAiWHF5IaSIE=";
    let hex = "2d711642b726b04401627ca9fbac32f5c8530fb1903cc4db02258717921a4881";
    let pairs: String =
        hex.as_bytes().chunks(2).map(|pair| format!(":{}{}", pair[0] as char, pair[1] as char)).collect();
    let age = "AGE-SECRET-KEY-1QYQSZQGPQYQSZQGPQYQSZQGPQYQSZQGPQYQSZQGPQYQSZQGPQYQSQ";
    for (text, shown) in [
        (format!("only `{base64}`, x"), "only `LXEWQrcm…`, x".to_owned()),
        (base64.replace('+', "-").replace('=', ""), "LXEWQrcm…".to_owned()),
        (format!("a={base64}"), "a=LXEWQr…".to_owned()),
        (hex.to_owned(), "2d711642…".to_owned()),
        (hex.to_uppercase(), "2D711642…".to_owned()),
        (pairs, ":2d:71:1…".to_owned()),
        (format!("«{age}» {age}"), "«AGE-SECR…» AGE-SECR…".to_owned()),
        (age.to_lowercase(), "age-secr…".to_owned()),
    ] {
        assert_eq!(without_secrets(&text), shown);
    }
    for other in [
        "",
        "SHA256:DVcCvVSg0vxIVDD6Fy/8K8+VwgvIM7+/UyYqqlJJq8E",
        "standard_uncertainty_of_the_deflection_xi_arcsec",
        "srv/stands/2026/passports/sps/0017/moscow/bmstu/1.yaml",
        &base64[..42],
        &hex[..63],
        &"1".repeat(200),
    ] {
        assert_eq!(without_secrets(other), other);
    }
}
