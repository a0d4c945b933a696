//! A step of Dormand and Prince's explicit Runge–Kutta method of order 8 with an estimate of its
//! error: DOP853 of E. Hairer, S. P. Nørsett and G. Wanner, Solving Ordinary Differential Equations
//! I, section II.5 (doi 10.1007/978-3-540-78862-1).

/// Values of the right-hand side in a step.
const STAGES: usize = 12;

const NODES: [f64; STAGES] = [
    0.0,
    0.05260015195876773,
    0.0789002279381516,
    0.1183503419072274,
    0.2816496580927726,
    0.3333333333333333,
    0.25,
    0.3076923076923077,
    0.6512820512820513,
    0.6,
    0.8571428571428571,
    1.0,
];

const COUPLING: [&[f64]; STAGES] = [
    &[],
    &[0.05260015195876773],
    &[0.0197250569845379, 0.0591751709536137],
    &[0.02958758547680685, 0.0, 0.08876275643042054],
    &[0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792],
    &[0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242],
    &[0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
    &[
        0.03709200011850479,
        0.0,
        0.0,
        0.17038392571223998,
        0.10726203044637328,
        -0.015319437748624402,
        0.008273789163814023,
    ],
    &[
        0.6241109587160757,
        0.0,
        0.0,
        -3.3608926294469414,
        -0.868219346841726,
        27.59209969944671,
        20.154067550477894,
        -43.48988418106996,
    ],
    &[
        0.47766253643826434,
        0.0,
        0.0,
        -2.4881146199716677,
        -0.590290826836843,
        21.230051448181193,
        15.279233632882423,
        -33.28821096898486,
        -0.020331201708508627,
    ],
    &[
        -0.9371424300859873,
        0.0,
        0.0,
        5.186372428844064,
        1.0914373489967295,
        -8.149787010746927,
        -18.52006565999696,
        22.739487099350505,
        2.4936055526796523,
        -3.0467644718982196,
    ],
    &[
        2.273310147516538,
        0.0,
        0.0,
        -10.53449546673725,
        -2.0008720582248625,
        -17.9589318631188,
        27.94888452941996,
        -2.8589982771350235,
        -8.87285693353063,
        12.360567175794303,
        0.6433927460157636,
    ],
];

const WEIGHTS: [f64; STAGES] = [
    0.054293734116568765,
    0.0,
    0.0,
    0.0,
    0.0,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    0.3111643669578199,
    -0.1521609496625161,
    0.20136540080403034,
    0.04471061572777259,
];

const FIFTH: [f64; STAGES] = [
    0.01312004499419488,
    0.0,
    0.0,
    0.0,
    0.0,
    -1.2251564463762044,
    -0.4957589496572502,
    1.6643771824549864,
    -0.35032884874997366,
    0.3341791187130175,
    0.08192320648511571,
    -0.022355307863886294,
];

const THIRD: [f64; STAGES] = [
    -0.18980075407240762,
    0.0,
    0.0,
    0.0,
    0.0,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    -0.4226823213237919,
    -0.1521609496625161,
    0.20136540080403034,
    0.02265179219836082,
];

/// A step, and the memory for it.
#[derive(Debug, Default)]
pub(super) struct RungeKutta {
    slopes: [Vec<f64>; STAGES],
    at: Vec<f64>,
    /// y at the end of the step.
    pub(super) end: Vec<f64>,
}

impl RungeKutta {
    pub(super) fn resize(&mut self, n: usize) {
        self.slopes.iter_mut().chain([&mut self.at, &mut self.end]).for_each(|x| x.resize(n, 0.0));
    }

    /// y' at the start of the step.
    pub(super) fn first_slope(&mut self) -> &mut [f64] {
        &mut self.slopes[0]
    }

    /// Takes a step of `h` (s) from `y`, whose [slope](Self::first_slope) is there: `slope(s, y, y')`
    /// writes that at the part s of the step. Leaves y at the end in `end`.
    pub(super) fn step<E>(
        &mut self,
        h: f64,
        y: &[f64],
        mut slope: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        for stage in 1..STAGES {
            let (before, after) = self.slopes.split_at_mut(stage);
            self.at.copy_from_slice(y);
            add(&mut self.at, h, COUPLING[stage], before);
            slope(NODES[stage], &self.at, &mut after[0])?;
        }
        self.end.copy_from_slice(y);
        add(&mut self.end, h, &WEIGHTS, &self.slopes);
        Ok(())
    }

    /// The error of the last step of `h` (s), measured by `scale`, one number for each of the first
    /// of y: at most 1 is good.
    pub(super) fn error(&self, h: f64, scale: &[f64]) -> f64 {
        let (mut fifth, mut third) = (0.0, 0.0);
        for (i, scale) in scale.iter().enumerate() {
            let sum = |weights: &[f64; STAGES]| -> f64 {
                weights.iter().zip(&self.slopes).map(|(w, k)| w * k[i]).sum::<f64>() / scale
            };
            fifth += sum(&FIFTH).powi(2);
            third += sum(&THIRD).powi(2);
        }
        if fifth == 0.0 { 0.0 } else { h * fifth / (fifth + 0.01 * third).sqrt() }
    }

    /// The step that would have an error of about 1, from one of `h` (s) with this error.
    pub(super) fn better(h: f64, error: f64) -> f64 {
        h * (0.9 * error.powf(-0.125)).clamp(0.2, 6.0)
    }
}

/// y += h Σ a k.
fn add(y: &mut [f64], h: f64, a: &[f64], k: &[Vec<f64>]) {
    for (a, k) in a.iter().zip(k).filter(|(a, _)| **a != 0.0) {
        let a = h * a;
        y.iter_mut().zip(k).for_each(|(y, k)| *y += a * k);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The end of y'' = −y from (1, 0) in `n` steps over the time 2.
    fn swing(n: usize) -> [f64; 2] {
        let (mut rk, h, mut y) = (RungeKutta::default(), 2.0 / n as f64, vec![1.0, 0.0]);
        rk.resize(2);
        let slope = |y: &[f64], k: &mut [f64]| {
            k.copy_from_slice(&[y[1], -y[0]]);
        };
        for _ in 0..n {
            slope(&y, rk.first_slope());
            let each = |_: f64, y: &[f64], k: &mut [f64]| -> Result<(), ()> {
                slope(y, k);
                Ok(())
            };
            rk.step(h, &y, each).unwrap();
            y.copy_from_slice(&rk.end);
        }
        [y[0], y[1]]
    }

    #[test]
    fn it_is_of_order_eight() {
        let error = |n| (swing(n)[0] - 2.0_f64.cos()).hypot(swing(n)[1] + 2.0_f64.sin());
        let order = (error(2) / error(4)).log2();
        assert!(order > 7.7 && error(4) < 1e-8, "{order} {:e}", error(4));
    }

    #[test]
    fn its_estimate_is_of_the_size_of_the_error() {
        let (mut rk, h) = (RungeKutta::default(), 0.8);
        rk.resize(1);
        rk.first_slope()[0] = 1.0;
        let each = |_: f64, y: &[f64], k: &mut [f64]| -> Result<(), ()> {
            k.copy_from_slice(y);
            Ok(())
        };
        rk.step(h, &[1.0], each).unwrap();
        let (error, estimate) = ((rk.end[0] - h.exp()).abs(), rk.error(h, &[1.0]));
        assert!(estimate > error && estimate < 1e3 * error, "{error:e} {estimate:e}");
        assert!(RungeKutta::better(h, 2.0) < h && RungeKutta::better(h, 0.01) > h);
    }
}
