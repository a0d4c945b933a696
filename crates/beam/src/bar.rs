//! The beam along its axis: linear elements with one dof u a node, consistent mass.

/// A symmetric tridiagonal matrix: per node its own entry and that with the next.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tridiagonal(pub(crate) Vec<[f64; 2]>);

impl Tridiagonal {
    fn assemble(elements: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut entries = vec![[0.0; 2]];
        for [own, next] in elements {
            let last = entries.len() - 1;
            entries[last] = [entries[last][0] + own, next];
            entries.push([own, 0.0]);
        }
        Self(entries)
    }
}

/// EA u'' = ρA ü by elements.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bar {
    /// EA/l, element by element.
    stiffness: Vec<f64>,
    /// ρA l/6, element by element.
    mass: Vec<f64>,
    /// Masses of single nodes.
    lumps: Vec<(usize, f64)>,
    /// Whether the node is held.
    pub(crate) held: Vec<bool>,
    pub(crate) m: Tridiagonal,
    pub(crate) k: Tridiagonal,
}

impl Bar {
    /// From EA and ρA of each element, its length, the masses of nodes and whether the ends are
    /// held.
    pub(crate) fn new(elements: &[(f64, f64, f64)], lumps: Vec<(usize, f64)>, ends: [bool; 2]) -> Self {
        let stiffness: Vec<f64> = elements.iter().map(|(ea, _, l)| ea / l).collect();
        let mass: Vec<f64> = elements.iter().map(|(_, rho_a, l)| rho_a * l / 6.0).collect();
        let mut m = Tridiagonal::assemble(mass.iter().map(|m| [2.0 * m, *m]));
        for (node, lump) in &lumps {
            m.0[*node][0] += lump;
        }
        let k = Tridiagonal::assemble(stiffness.iter().map(|k| [*k, -k]));
        let mut held = vec![false; elements.len() + 1];
        held[0] = ends[0];
        held[elements.len()] = ends[1];
        Self { stiffness, mass, lumps, held, m, k }
    }

    pub(crate) fn add_mass_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        for (k, m) in self.mass.iter().enumerate() {
            let m = a * m;
            y[k] += m * (2.0 * x[k] + x[k + 1]);
            y[k + 1] += m * (x[k] + 2.0 * x[k + 1]);
        }
        for (node, m) in &self.lumps {
            y[*node] += a * m * x[*node];
        }
    }

    pub(crate) fn add_stiffness_product(&self, a: f64, x: &[f64], y: &mut [f64]) {
        for (k, stiffness) in self.stiffness.iter().enumerate() {
            let force = a * stiffness * (x[k + 1] - x[k]);
            y[k] -= force;
            y[k + 1] += force;
        }
    }

    /// vᵀM v.
    pub(crate) fn mass_form(&self, v: &[f64]) -> f64 {
        let element = |(k, m): (usize, &f64)| {
            let (sum, difference) = (v[k] + v[k + 1], v[k + 1] - v[k]);
            m * (1.5 * sum * sum + 0.5 * difference * difference)
        };
        let lumps: f64 = self.lumps.iter().map(|(node, m)| m * v[*node] * v[*node]).sum();
        self.mass.iter().enumerate().map(element).sum::<f64>() + lumps
    }

    /// uᵀK u.
    pub(crate) fn stiffness_form(&self, u: &[f64]) -> f64 {
        let element = |(k, stiffness): (usize, &f64)| {
            let stretch = u[k + 1] - u[k];
            stiffness * stretch * stretch
        };
        self.stiffness.iter().enumerate().map(element).sum()
    }

    /// The normal force of each element, N, tension positive.
    pub(crate) fn forces(&self, u: &[f64]) -> impl Iterator<Item = f64> {
        self.stiffness.iter().enumerate().map(move |(k, stiffness)| stiffness * (u[k + 1] - u[k]))
    }
}

/// L D Lᵀ of mM + cC + kK of a bar: (1/d, l) a node, 1/d = 0 for held ones.
#[derive(Debug, Clone)]
pub(crate) struct BarFactor(Vec<[f64; 2]>);

impl BarFactor {
    pub(crate) fn new(nodes: usize) -> Self {
        Self(vec![[f64::NAN; 2]; nodes])
    }

    /// Factorises mass·M + stiffness·K; the error is the number of the node whose pivot is not
    /// positive.
    pub(crate) fn factorise(&mut self, bar: &Bar, mass: f64, stiffness: f64) -> Result<(), usize> {
        let mut less = 0.0;
        for k in 0..self.0.len() {
            let [own, next] = [0, 1].map(|i| mass * bar.m.0[k][i] + stiffness * bar.k.0[k][i]);
            if bar.held[k] {
                (self.0[k], less) = ([0.0; 2], 0.0);
                continue;
            }
            let pivot = own - less;
            if !(pivot > 0.0 && pivot.is_finite()) {
                self.0.fill([f64::NAN; 2]);
                return Err(k);
            }
            let next = if bar.held.get(k + 1).copied().unwrap_or(true) { 0.0 } else { next };
            let l = next / pivot;
            (self.0[k], less) = ([1.0 / pivot, l], l * next);
        }
        Ok(())
    }

    pub(crate) fn solve(&self, f: &mut [f64]) {
        let mut passed = 0.0;
        for (x, [_, l]) in f.iter_mut().zip(&self.0) {
            *x -= passed;
            passed = l * *x;
        }
        let mut next = 0.0;
        for (x, [inverse, l]) in f.iter_mut().zip(&self.0).rev() {
            *x = *x * inverse - l * next;
            next = *x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solving_undoes_the_products_and_held_ends_stay() {
        let elements = [(3.0, 2.0, 0.5), (4.0, 2.0, 0.25), (3.0, 1.0, 0.5)];
        for ends in [[false, false], [true, false], [false, true], [true, true]] {
            let bar = Bar::new(&elements, vec![(1, 0.7)], ends);
            let mut x = [0.3, -0.8, 0.5, 1.1];
            if ends[0] {
                x[0] = 0.0;
            }
            if ends[1] {
                x[3] = 0.0;
            }
            let mut y = [0.0; 4];
            bar.add_mass_product(1.0, &x, &mut y);
            let kinetic: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
            assert!((bar.mass_form(&x) / kinetic - 1.0).abs() < 1e-14);
            bar.add_stiffness_product(0.1, &x, &mut y);
            let elastic: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum::<f64>() - kinetic;
            assert!((0.1 * bar.stiffness_form(&x) / elastic - 1.0).abs() < 1e-13);
            let mut factor = BarFactor::new(4);
            factor.factorise(&bar, 1.0, 0.1).unwrap();
            factor.solve(&mut y);
            assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-14), "{ends:?} {y:?}");
        }
    }
}
