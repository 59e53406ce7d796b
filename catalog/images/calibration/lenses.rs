//! Lens models by the names that drivers and programs give them.

use furrow_model::Distortion;

/// The names under which a lens model's coefficients are used, for errors.
pub const KNOWN_MODELS: &str = "plumb_bob, rational_polynomial, radtan, equidistant, fisheye or Kannala_Brandt4, or coefficients that are all zero";

/// The lens model that `name` stands for, in any spelling with capitals, blanks and hyphens; `None` where its
/// coefficients are those of a model that is not read. A lens without coefficients, or with zeros only, bends nothing,
/// whatever its name.
pub fn distortion_named(name: &str, coefficients: &[f64]) -> Option<Distortion> {
    let plain = name.trim().to_ascii_lowercase().replace(['-', ' '], "_");
    match plain.as_str() {
        "plumb_bob" | "rational_polynomial" | "radtan" | "radial_tangential" => Some(Distortion::RadialTangential),
        "equidistant" | "equi" | "fisheye" | "kannala_brandt4" | "kannala_brandt" => Some(Distortion::Equidistant),
        // Four numbers without a name may be of either model.
        "" if coefficients.len() > 4 => Some(Distortion::RadialTangential),
        _ => bends_nothing(coefficients).then_some(Distortion::RadialTangential),
    }
}

/// Whether these coefficients leave every ray as it is, in the radial and tangential model.
pub fn bends_nothing(coefficients: &[f64]) -> bool {
    coefficients.iter().all(|&coefficient| coefficient == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_every_spelling_and_lenses_that_bend_nothing() {
        let bent = [0.1, 0.2, 0.0, 0.0];
        for name in ["plumb_bob", "PLUMB_BOB", "Plumb Bob", "radtan", "radial-tangential", "rational_polynomial"] {
            assert_eq!(distortion_named(name, &bent), Some(Distortion::RadialTangential), "{name}");
        }
        for name in ["equidistant", "Fisheye", "Kannala_Brandt4", "kannala_brandt4"] {
            assert_eq!(distortion_named(name, &bent), Some(Distortion::Equidistant), "{name}");
        }
        for name in ["inverse_brown_conrady", "thin_prism_fisheye", "pinhole", "", "none", "Ω"] {
            assert_eq!(distortion_named(name, &bent), None, "{name}");
            assert_eq!(distortion_named(name, &[0.0; 5]), Some(Distortion::RadialTangential), "{name}");
            assert_eq!(distortion_named(name, &[]), Some(Distortion::RadialTangential), "{name}");
        }
        assert_eq!(distortion_named("", &[0.1; 5]), Some(Distortion::RadialTangential));
    }
}
