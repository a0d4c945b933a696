//! Cross-sections: what of them enters the equation of motion.

use std::f64::consts::PI;

use crate::error::{BeamError, check};

/// The outline of a cross-section, m. The beam bends in the plane of its height.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Profile {
    /// A solid rectangle.
    Rectangle {
        /// Side out of the plane of bending.
        width: f64,
        /// Side in the plane of bending.
        thickness: f64,
    },
    /// A solid circle.
    Circle {
        /// Its diameter.
        diameter: f64,
    },
    /// A circular tube.
    Tube {
        /// Outer diameter.
        diameter: f64,
        /// Thickness of the wall; half the diameter is a solid circle.
        wall: f64,
    },
    /// An I-section of two equal flanges and a web, without fillets.
    ISection {
        /// Overall height.
        height: f64,
        /// Width of the flanges.
        width: f64,
        /// Thickness of the web.
        web: f64,
        /// Thickness of a flange.
        flange: f64,
    },
}

impl Profile {
    /// Area A, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        match *self {
            Self::Rectangle { width, thickness } => width * thickness,
            Self::Circle { diameter } => 0.25 * PI * diameter * diameter,
            // In products of wall and mean diameter: a thin wall keeps its digits.
            Self::Tube { diameter, wall } => PI * wall * (diameter - wall),
            Self::ISection { height, width, web, flange } => 2.0 * width * flange + web * (height - 2.0 * flange),
        }
    }

    /// Second moment of area I about the axis of bending, m⁴.
    #[must_use]
    pub fn second_moment(&self) -> f64 {
        match *self {
            Self::Rectangle { width, thickness } => width * thickness * thickness * thickness / 12.0,
            Self::Circle { diameter } => PI * diameter.powi(4) / 64.0,
            Self::Tube { diameter, wall } => {
                let inner = diameter - 2.0 * wall;
                self.area() * (diameter * diameter + inner * inner) / 16.0
            }
            Self::ISection { height, width, web, flange } => {
                let clear = height - 2.0 * flange;
                let arm = 0.5 * (height - flange);
                2.0 * width * flange * (flange * flange / 12.0 + arm * arm) + web * clear * clear * clear / 12.0
            }
        }
    }

    /// Largest distance of a fibre from the axis, m: half the height.
    #[must_use]
    pub fn fibre(&self) -> f64 {
        match *self {
            Self::Rectangle { thickness, .. } => 0.5 * thickness,
            Self::Circle { diameter } | Self::Tube { diameter, .. } => 0.5 * diameter,
            Self::ISection { height, .. } => 0.5 * height,
        }
    }

    /// Shear coefficient κ of Timoshenko's theory for Poisson's ratio ν, without unit: A_s = κ A.
    /// Cowper (1966, doi 10.1115/1.3625046). For an I-section that is his thin-walled one, with the flanges as lines at the distance of
    /// their middles: for rolled sections 4 to 8 % below what the energy of the shear stresses gives.
    #[must_use]
    pub fn shear_coefficient(&self, poisson_ratio: f64) -> f64 {
        let nu = poisson_ratio;
        match *self {
            Self::Rectangle { .. } => 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu),
            Self::Circle { .. } => 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu),
            Self::Tube { diameter, wall } => {
                let m = 1.0 - 2.0 * wall / diameter;
                let square = (1.0 + m * m) * (1.0 + m * m);
                6.0 * (1.0 + nu) * square / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * m * m)
            }
            Self::ISection { height, width, web, flange } => {
                let distance = height - flange;
                let (m, n) = (2.0 * width * flange / (distance * web), width / distance);
                let square = (1.0 + 3.0 * m) * (1.0 + 3.0 * m);
                // Polynomials in m, and what the shear in the flanges adds.
                let without = 12.0 + m * (72.0 + m * (150.0 + m * 90.0));
                let with_nu = 11.0 + m * (66.0 + m * (135.0 + m * 90.0));
                let flanges = n * n * m * (30.0 * (1.0 + m) + 5.0 * nu * (8.0 + 9.0 * m));
                10.0 * (1.0 + nu) * square / (without + nu * with_nu + flanges)
            }
        }
    }

    fn validate(&self) -> Result<(), BeamError> {
        match *self {
            Self::Rectangle { width, thickness } => {
                positive("width", width)?;
                positive("thickness", thickness)
            }
            Self::Circle { diameter } => positive("diameter", diameter),
            Self::Tube { diameter, wall } => {
                positive("diameter", diameter)?;
                check("wall", wall, wall > 0.0 && wall <= 0.5 * diameter, "> 0 and at most half the diameter")
            }
            Self::ISection { height, width, web, flange } => {
                positive("height", height)?;
                positive("width", width)?;
                check("web", web, web > 0.0 && web <= width, "> 0 and at most the width")?;
                check("flange", flange, flange > 0.0 && flange < 0.5 * height, "> 0 and less than half the height")
            }
        }
    }
}

/// What a cross-section contributes to the equation of motion.
///
/// [`Section::new`] is an Euler–Bernoulli beam without rotatory inertia; the `with_…` methods add
/// what a model asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Section {
    /// Bending stiffness EI, N m².
    pub bending_stiffness: f64,
    /// Mass per length ρA, kg/m.
    pub mass_per_length: f64,
    /// Shear stiffness GA_s = κ G A, N; infinite for Euler–Bernoulli.
    pub shear_stiffness: f64,
    /// Rotatory inertia per length ρI, kg m; 0 to leave it out.
    pub rotatory_inertia: f64,
    /// Axial stiffness EA, N, if known. A beam that is held along its axis, or has axial dofs,
    /// needs it.
    pub axial_stiffness: Option<f64>,
    /// Area A, m², if known: by it an axial force adds to the stress.
    pub area: Option<f64>,
    /// Elastic section modulus I/c, m³, if known: by it a bending moment makes the largest stress.
    pub section_modulus: Option<f64>,
}

impl Section {
    /// A section by its bending stiffness EI (N m²) and its mass per length ρA (kg/m).
    ///
    /// # Errors
    /// [`BeamError::Value`] where one is not finite and positive.
    ///
    /// ```
    /// let section = teeter_beam::Section::new(0.5821875, 0.1215)?;
    /// assert_eq!(section.mass_per_length, 0.1215);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn new(bending_stiffness: f64, mass_per_length: f64) -> Result<Self, BeamError> {
        let section = Self {
            bending_stiffness,
            mass_per_length,
            shear_stiffness: f64::INFINITY,
            rotatory_inertia: 0.0,
            axial_stiffness: None,
            area: None,
            section_modulus: None,
        };
        section.validate()?;
        Ok(section)
    }

    /// A profile of one material, Young's modulus in Pa and density in kg/m³: EI, ρA, EA and I/c.
    ///
    /// # Errors
    /// [`BeamError::Value`] where a number, or a product of them, is not finite and positive, or
    /// the walls of a profile don't fit into it.
    ///
    /// ```
    /// use teeter_beam::{Profile, Section};
    /// let tube = Section::of(Profile::Tube { diameter: 0.1, wall: 0.005 }, 210e9, 7850.0)?;
    /// let bar = Section::of(Profile::Circle { diameter: 0.1 }, 210e9, 7850.0)?;
    /// assert!(tube.mass_per_length < 0.2 * bar.mass_per_length && tube.bending_stiffness > 0.3 * bar.bending_stiffness);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn of(profile: Profile, youngs_modulus: f64, density: f64) -> Result<Self, BeamError> {
        profile.validate()?;
        positive("youngs_modulus", youngs_modulus)?;
        positive("density", density)?;
        let second_moment = profile.second_moment();
        // E first: E b t³/12 in this order is what the closed form of a rectangle has always been
        // rounded to.
        let bending_stiffness = match profile {
            Profile::Rectangle { width, thickness } => {
                youngs_modulus * width * thickness * thickness * thickness / 12.0
            }
            _ => youngs_modulus * second_moment,
        };
        let mass_per_length = match profile {
            Profile::Rectangle { width, thickness } => density * width * thickness,
            _ => density * profile.area(),
        };
        let section = Self {
            axial_stiffness: Some(youngs_modulus * profile.area()),
            area: Some(profile.area()),
            section_modulus: Some(second_moment / profile.fibre()),
            ..Self::new(bending_stiffness, mass_per_length)?
        };
        section.validate()?;
        Ok(section)
    }

    /// A solid rectangle of `width` and `thickness` (m; the beam bends across its thickness),
    /// Young's modulus (Pa) and density (kg/m³): EI = E b t³/12, ρA = ρ b t.
    ///
    /// # Errors
    /// As [`Section::of`].
    ///
    /// ```
    /// let section = teeter_beam::Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?;
    /// assert!((section.bending_stiffness - 0.5821875).abs() < 1e-15);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn rectangle(width: f64, thickness: f64, youngs_modulus: f64, density: f64) -> Result<Self, BeamError> {
        Self::of(Profile::Rectangle { width, thickness }, youngs_modulus, density)
    }

    /// The same section with Timoshenko's shear flexibility and rotatory inertia: GA_s in N, ρI in
    /// kg m.
    ///
    /// # Errors
    /// [`BeamError::Value`] for a shear stiffness that is not positive, or an inertia that is
    /// negative or not finite.
    pub fn with_shear(self, shear_stiffness: f64, rotatory_inertia: f64) -> Result<Self, BeamError> {
        let section = Self { shear_stiffness, rotatory_inertia, ..self };
        section.validate()?;
        Ok(section)
    }

    /// [`Section::with_shear`] of a profile of one material: κ by [`Profile::shear_coefficient`],
    /// G = E/(2(1 + ν)).
    ///
    /// # Errors
    /// As [`Section::of`]; [`BeamError::Value`] for a Poisson's ratio outside (−1, ½].
    ///
    /// ```
    /// use teeter_beam::{Profile, Section};
    /// let profile = Profile::Rectangle { width: 0.05, thickness: 0.1 };
    /// let section = Section::timoshenko(profile, 210e9, 7850.0, 0.3)?;
    /// assert!((section.shear_stiffness / (0.85 * 210e9 / 2.6 * 0.005) - 1.0).abs() < 1e-3);
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn timoshenko(
        profile: Profile,
        youngs_modulus: f64,
        density: f64,
        poisson_ratio: f64,
    ) -> Result<Self, BeamError> {
        let holds = poisson_ratio > -1.0 && poisson_ratio <= 0.5;
        check("poisson_ratio", poisson_ratio, holds, "in (-1, 0.5]")?;
        let shear_modulus = youngs_modulus / (2.0 * (1.0 + poisson_ratio));
        let shear = profile.shear_coefficient(poisson_ratio) * shear_modulus * profile.area();
        Self::of(profile, youngs_modulus, density)?.with_shear(shear, density * profile.second_moment())
    }

    /// The same section with an axial stiffness EA, N.
    ///
    /// # Errors
    /// [`BeamError::Value`] for one that is not finite and positive.
    pub fn with_axial_stiffness(self, axial_stiffness: f64) -> Result<Self, BeamError> {
        positive("section.axial_stiffness", axial_stiffness)?;
        Ok(Self { axial_stiffness: Some(axial_stiffness), ..self })
    }

    /// EA, N; of a beam that needs it [`BeamSpec::validate`](crate::BeamSpec) has seen that it is
    /// there.
    pub(crate) fn axial(&self) -> f64 {
        self.axial_stiffness.unwrap_or(0.0)
    }

    /// Φ = 12 EI/(GA_s l²) of an element of length l: the share of shear in its flexibility; 0 for
    /// Euler–Bernoulli.
    pub(crate) fn shear_parameter(&self, length: f64) -> f64 {
        12.0 * self.bending_stiffness / (self.shear_stiffness * length * length)
    }

    pub(crate) fn validate(&self) -> Result<(), BeamError> {
        positive("section.bending_stiffness", self.bending_stiffness)?;
        positive("section.mass_per_length", self.mass_per_length)?;
        if self.shear_stiffness != f64::INFINITY {
            check("section.shear_stiffness", self.shear_stiffness, self.shear_stiffness > 0.0, "> 0")?;
        }
        not_negative("section.rotatory_inertia", self.rotatory_inertia)?;
        let known = [
            ("section.axial_stiffness", self.axial_stiffness),
            ("section.area", self.area),
            ("section.section_modulus", self.section_modulus),
        ];
        known.into_iter().try_for_each(|(field, value)| value.map_or(Ok(()), |value| positive(field, value)))
    }
}

pub(crate) fn positive(field: &'static str, value: f64) -> Result<(), BeamError> {
    check(field, value, value > 0.0, "finite and > 0")
}

pub(crate) fn not_negative(field: &'static str, value: f64) -> Result<(), BeamError> {
    check(field, value, value >= 0.0, "finite and >= 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_agree_where_they_are_the_same_shape() {
        let circle = Profile::Circle { diameter: 0.2 };
        let solid = Profile::Tube { diameter: 0.2, wall: 0.1 };
        let bar = Profile::Rectangle { width: 0.1, thickness: 0.3 };
        let filled = Profile::ISection { height: 0.3, width: 0.1, web: 0.1, flange: 0.05 };
        for (a, b) in [(circle, solid), (bar, filled)] {
            assert!((a.area() / b.area() - 1.0).abs() < 1e-14);
            assert!((a.second_moment() / b.second_moment() - 1.0).abs() < 1e-14);
            assert_eq!(a.fibre(), b.fibre());
        }
        assert!((circle.shear_coefficient(0.3) / solid.shear_coefficient(0.3) - 1.0).abs() < 1e-14);
    }

    /// IPE 200 without its fillets: 200 × 100 × 5.6 × 8.5 mm. By hand: A = 2·850 + 183·5.6 mm²,
    /// I = 2(100·8.5³/12 + 850·95.75²) + 5.6·183³/12 mm⁴.
    #[test]
    fn an_i_section_is_the_sum_of_its_plates() {
        let profile = Profile::ISection { height: 0.2, width: 0.1, web: 0.0056, flange: 0.0085 };
        assert!((profile.area() - 2724.8e-6).abs() < 1e-15);
        let plates =
            2.0 * (100.0 * 8.5_f64.powi(3) / 12.0 + 850.0 * 95.75_f64.powi(2)) + 5.6 * 183.0_f64.powi(3) / 12.0;
        assert!((profile.second_moment() / (plates * 1e-12) - 1.0).abs() < 1e-14);
    }

    /// The shear stresses of a thin-walled I-section by its first moments S: κ = I²/(A ∫ S²/t ds), which is Cowper's value for ν = 0.
    /// S = t_f h s/2 along each half of a flange, and t_f h b/2 + t_w (h²/4 − y²)/2 in the web.
    #[test]
    fn shear_of_an_i_section_is_that_of_its_thin_walls() {
        for (width, web, flange) in [(0.1, 5.6e-6, 8.5e-6), (0.3, 2e-5, 1e-5), (1e-5, 1e-5, 1e-9)] {
            let h = 0.2;
            let profile = Profile::ISection { height: h + flange, width, web, flange };
            let area = 2.0 * width * flange + h * web;
            let second_moment = 0.5 * width * flange * h * h + web * h.powi(3) / 12.0;
            let of_flanges = 4.0 * flange * h * h / 4.0 * (0.5 * width).powi(3) / 3.0;
            let (edge, web_moment) = (0.5 * flange * h * width, web * h * h / 8.0);
            // ∫ (edge + web_moment (1 − η²))² dη over the web.
            let of_web = (edge * edge + 4.0 / 3.0 * edge * web_moment + 8.0 / 15.0 * web_moment * web_moment) * h / web;
            let exact = second_moment * second_moment / (area * (of_flanges + of_web));
            assert!((profile.shear_coefficient(0.0) / exact - 1.0).abs() < 1e-4, "{width}: {exact}");
        }
        // Cowper's formula by hand for IPE 200 without its fillets and ν = 0.3.
        let ipe = Profile::ISection { height: 0.2, width: 0.1, web: 0.0056, flange: 0.0085 };
        assert!((ipe.shear_coefficient(0.3) - 0.3733).abs() < 5e-5);
        // Without flanges it is a rectangle.
        let bar = Profile::Rectangle { width: 0.1, thickness: 0.3 };
        let bare = Profile::ISection { height: 0.3, width: 0.1, web: 0.1, flange: 1e-9 };
        assert!((bare.shear_coefficient(0.3) / bar.shear_coefficient(0.3) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_thin_wall_keeps_its_digits() {
        let (diameter, wall) = (1.0, 1e-12);
        let tube = Profile::Tube { diameter, wall };
        assert!((tube.area() / (PI * diameter * wall) - 1.0).abs() < 1e-11);
        assert!((tube.second_moment() / (PI * diameter.powi(3) * wall / 8.0) - 1.0).abs() < 1e-11);
    }

    #[test]
    fn walls_that_do_not_fit_are_refused_by_name() {
        for (profile, field) in [
            (Profile::Tube { diameter: 0.1, wall: 0.06 }, "wall"),
            (Profile::ISection { height: 0.2, width: 0.1, web: 0.2, flange: 0.01 }, "web"),
            (Profile::ISection { height: 0.2, width: 0.1, web: 0.01, flange: 0.1 }, "flange"),
            (Profile::Circle { diameter: f64::NAN }, "diameter"),
        ] {
            let text = Section::of(profile, 1e9, 1e3).unwrap_err().to_string();
            assert!(text.starts_with(field), "{text}");
        }
        let circle = Profile::Circle { diameter: 0.1 };
        assert!(Section::timoshenko(circle, 1e9, 1e3, 0.6).unwrap_err().to_string().starts_with("poisson_ratio"));
    }
}
