//! What must hold for a subsystem that stretches.

use super::{Check, Property, ROUNDING, SOLVED, distance, largest};
use crate::subsystem::dot;

impl Check<'_> {
    /// `x` and `y` are 0 for held velocities, `inner` for driven ones too.
    pub(super) fn tension(&mut self, x: &[f64], y: &[f64], inner: &[f64]) {
        let Some(stretching) = self.system.stretching() else { return };
        let (q, w, n) = (&self.case.q, self.case.weights, x.len());
        let product = |x: &[f64]| {
            let mut y = vec![0.0; n];
            stretching.add_product(1.0, x, &mut y);
            y
        };
        let (gx, gy) = (product(x), product(y));
        let allowed = ROUNDING * (1.0 + n as f64) * largest(&gx).max(largest(&gy));
        let form = stretching.form(x, y);
        self.hold(Property::Stretching, "xᵀG y", (form - dot(&gx, y)).abs(), allowed);
        self.hold(Property::Stretching, "G is symmetric", (form - dot(&gy, x)).abs(), allowed);

        let (mut all, mut beside) = (vec![0.0; n], vec![0.0; n]);
        self.system.internal_force(q, x, &mut all);
        stretching.force_beside(q, x, &mut beside);
        let tension = stretching.stiffness() * stretching.form(q, q);
        stretching.add_product(-tension, q, &mut beside);
        let allowed = ROUNDING * (1.0 + largest(&all) + tension * largest(&product(q)));
        self.hold(Property::Stretching, "the force of the tension", distance(&all, &beside), allowed);

        let Ok(mut factor) = self.system.factor(w, q) else { return };
        // Twice, so that nothing of the first is left.
        factor.stretch(0.5 * tension, 0.3, &gx);
        let (g, weight) = (product(q), w.stiffness * stretching.stiffness());
        factor.stretch(tension, weight, &g);
        let mut f = self.product(w, inner);
        stretching.add_product(w.stiffness * tension, inner, &mut f);
        let along = weight * dot(&g, inner);
        f.iter_mut().zip(&g).for_each(|(f, g)| *f += along * g);
        factor.solve(&mut f);
        self.hold(Property::Stretching, "W (mM + cC + k(K + N G) + r g gᵀ) x = x", distance(&f, inner), SOLVED);
    }
}
