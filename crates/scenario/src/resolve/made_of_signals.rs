//! Resolves signals that are made of others: sums and products.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Resolver;
use crate::scene::{History, ProductScene, SignalScene};

/// How deep sums and products may be nested.
const DEEPEST: usize = 32;

/// Most signals in a sum, those of its sums included.
const MOST_TERMS: usize = 500;

/// Largest factor of a signal in a sum, as of all numbers in scenes.
const LARGEST_FACTOR: f64 = 1e12;

/// How a signal is made of others.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Made {
    Sum,
    Product,
}

impl Made {
    /// The key with the names of its signals.
    const fn key(self) -> &'static str {
        match self {
            Self::Sum => "terms",
            Self::Product => "factors",
        }
    }

    /// The part of the table that is made so.
    fn of(shape: Option<&str>) -> Option<Self> {
        match shape? {
            "sum" => Some(Self::Sum),
            "product" => Some(Self::Product),
            _ => None,
        }
    }
}

/// How far the sums and products of a scene are resolved.
struct Progress {
    /// The signals by number: all others from the start.
    signals: Vec<Option<SignalScene>>,
    /// How the sums and products are made, and of which signals.
    made: BTreeMap<usize, (Made, Vec<String>)>,
    /// The factors of the signals in each sum that is resolved; `None` if it is wrong.
    flat: BTreeMap<usize, Option<BTreeMap<usize, f64>>>,
    /// The products that are resolved, right or wrong.
    products: Vec<usize>,
    /// The signals that are being resolved, each a part of the one before.
    open: Vec<usize>,
}

impl Resolver<'_, '_> {
    /// All signals, in the order of the scene; sums and products are resolved last.
    pub(super) fn all_signals(&mut self) -> Vec<Option<SignalScene>> {
        let names = self.doc.names("signal");
        let mut made = BTreeMap::new();
        let mut signals = Vec::new();
        for (number, name) in names.iter().enumerate() {
            let Some(how) = Made::of(self.doc.text(&format!("signal.{name}.shape"))) else {
                signals.push(self.signal(name));
                continue;
            };
            signals.push(None);
            let path = format!("signal.{name}.{}", how.key());
            if let Some(given) = self.required(&path, self.doc.words(&path)) {
                made.insert(number, (how, given.to_vec()));
            }
        }
        let numbers: Vec<usize> = made.keys().copied().collect();
        let mut progress = Progress { signals, made, flat: BTreeMap::new(), products: Vec::new(), open: Vec::new() };
        for number in numbers {
            if let Some(history) = self.whole(number, &names, &mut progress)
                && let Some(scale) = self.scale(names[number])
            {
                progress.signals[number] = Some(SignalScene { name: names[number].to_owned(), history, scale });
            }
        }
        progress.signals
    }

    /// The history of a signal, without its scale; `None` if it is wrong, which has its own message.
    fn whole(&mut self, number: usize, names: &[&str], progress: &mut Progress) -> Option<History> {
        match progress.made.get(&number)?.0 {
            Made::Sum => {
                let flat = self.sum(number, names, progress)?;
                let history = flat.iter().map(|(term, factor)| {
                    let signal = progress.signals.get(*term)?.as_ref()?;
                    Some((*factor, signal.history.clone()))
                });
                Some(History::Sum(history.collect::<Option<Arc<[_]>>>()?))
            }
            Made::Product => {
                self.product(number, names, progress);
                Some(progress.signals.get(number)?.as_ref()?.history.clone())
            }
        }
    }

    /// The factors of the signals in a sum.
    fn sum(&mut self, number: usize, names: &[&str], progress: &mut Progress) -> Option<BTreeMap<usize, f64>> {
        if let Some(known) = progress.flat.get(&number) {
            return known.clone();
        }
        progress.open.push(number);
        let flat = self.terms(number, names, progress);
        progress.open.pop();
        progress.flat.insert(number, flat.clone());
        flat
    }

    fn terms(&mut self, number: usize, names: &[&str], progress: &mut Progress) -> Option<BTreeMap<usize, f64>> {
        let path = format!("signal.{}.terms", names[number]);
        let mut factors = BTreeMap::new();
        let mut good = true;
        for name in progress.made.get(&number)?.1.clone() {
            let term = match self.component(&path, &name, names, progress) {
                Ok(Some(term)) => term,
                Ok(None) => {
                    good = false;
                    continue;
                }
                Err(TooDeep) => return None,
            };
            let is_sum = matches!(progress.made.get(&term), Some((Made::Sum, _)));
            let (inner, scale) = if is_sum {
                (self.sum(term, names, progress), self.scale(&name))
            } else {
                self.product(term, names, progress);
                let known = progress.signals.get(term).and_then(Option::as_ref);
                (known.map(|_| BTreeMap::from([(term, 1.0)])), known.map(|signal| signal.scale))
            };
            // What is wrong with a term is reported there.
            let (Some(inner), Some(scale)) = (inner, scale) else {
                good = false;
                continue;
            };
            for (leaf, factor) in inner {
                *factors.entry(leaf).or_insert(0.0) += scale * factor;
            }
        }
        if factors.len() > MOST_TERMS {
            let rule = format!("it adds {} signals, but {MOST_TERMS} is the limit", factors.len());
            self.error(&path, rule, "put the smaller ones into a table of their values (shape = \"table\")");
            return None;
        }
        if let Some((leaf, factor)) = factors.iter().find(|(_, factor)| factor.abs() > LARGEST_FACTOR) {
            let rule = format!("its factor of `{}` is {factor:e}, over {LARGEST_FACTOR:e}", names[*leaf]);
            self.error(&path, rule, "use smaller scales, and larger amplitudes where the sum is used");
            return None;
        }
        good.then_some(factors)
    }

    /// Resolves a product, unless it is known or no product.
    fn product(&mut self, number: usize, names: &[&str], progress: &mut Progress) {
        let is_product = matches!(progress.made.get(&number), Some((Made::Product, _)));
        if !is_product || progress.products.contains(&number) {
            return;
        }
        progress.products.push(number);
        progress.open.push(number);
        let scene = self.factors(number, names, progress);
        progress.open.pop();
        if let Some(scene) = scene
            && let Some(scale) = self.scale(names[number])
        {
            let history = History::Product(Arc::new(scene));
            progress.signals[number] = Some(SignalScene { name: names[number].to_owned(), history, scale });
        }
    }

    fn factors(&mut self, number: usize, names: &[&str], progress: &mut Progress) -> Option<ProductScene> {
        let path = format!("signal.{}.factors", names[number]);
        let (mut factors, mut scale) = (Vec::new(), 1.0);
        let mut good = true;
        for name in progress.made.get(&number)?.1.clone() {
            let factor = match self.component(&path, &name, names, progress) {
                Ok(Some(factor)) => factor,
                Ok(None) => {
                    good = false;
                    continue;
                }
                Err(TooDeep) => return None,
            };
            let history = match progress.made.contains_key(&factor) {
                true => self.whole(factor, names, progress),
                false => progress.signals.get(factor).and_then(Option::as_ref).map(|signal| signal.history.clone()),
            };
            let (Some(history), Some(own)) = (history, self.scale(&name)) else {
                good = false;
                continue;
            };
            scale *= own;
            factors.push(history);
        }
        if scale.abs() > LARGEST_FACTOR {
            let rule = format!("the scales of its factors multiply to {scale:e}, over {LARGEST_FACTOR:e}");
            self.error(&path, rule, "use smaller scales, and a larger amplitude where the product is used");
            return None;
        }
        // Without an end the scene is wrong, which has its own message.
        let until = self.doc.quantity("time.end").filter(|_| good)?;
        match ProductScene::new(scale, factors, until) {
            Ok(scene) => Some(scene),
            Err(error) => {
                let remedy =
                    "multiply fewer signals, or put the product into a table of its values (shape = \"table\")";
                self.error(&path, error.to_string(), remedy);
                None
            }
        }
    }

    /// The number of a signal of which another is made; `None` if it can't be.
    fn component(
        &mut self,
        path: &str,
        name: &str,
        names: &[&str],
        progress: &Progress,
    ) -> Result<Option<usize>, TooDeep> {
        let Some(part) = self.signals.get(name).copied() else {
            self.not_defined(path, name);
            return Ok(None);
        };
        let open = &progress.open;
        let is_sum = |number: &usize| matches!(progress.made.get(number), Some((Made::Sum, _)));
        let only_sums = open.iter().all(is_sum);
        if let Some(at) = open.iter().position(|open| *open == part) {
            let around: Vec<String> = open[at..].iter().map(|k| format!("`{}`", names[*k])).collect();
            let what = if only_sums { "the sums add each other" } else { "the signals are made of each other" };
            let rule = format!("{what}: {} → `{name}`", around.join(" → "));
            self.error(path, rule, format!("leave `{name}` out, or name signals that don't contain this one"));
            return Ok(None);
        }
        if open.len() >= DEEPEST && progress.made.contains_key(&part) {
            let what = if only_sums { "sums of sums" } else { "sums and products of each other" };
            let rule = format!("{what}, {} deep, but {DEEPEST} is the limit", DEEPEST + 1);
            self.error(path, rule, "name the signals themselves instead of what is made of them");
            return Err(TooDeep);
        }
        Ok(Some(part))
    }
}

/// Sums and products are nested too deep, which is reported.
struct TooDeep;
