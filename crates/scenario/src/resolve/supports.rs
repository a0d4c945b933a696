//! Resolves supports, masses and meshes of beams.

use teeter_beam::{Hold, InnerSupport, Lump, SAME_PLACE, Support};

use super::Resolver;
use crate::value::Item;

/// The numbers and words of a support, by key.
struct SupportKeys<'a> {
    number: &'a dyn Fn(&str) -> Option<f64>,
    text: &'a dyn Fn(&str) -> Option<&'a str>,
}

/// The keys of each motion: word, spring, dashpot.
const MOTIONS: [[&str; 3]; 2] =
    [["deflection", "spring", "dashpot"], ["rotation", "rotational_spring", "rotational_dashpot"]];

impl Resolver<'_, '_> {
    /// The supports of both ends.
    pub(super) fn supports(&mut self, path: &str) -> Option<[Support; 2]> {
        let items = self.doc.item_pair(path);
        let [left, right] = self.required(path, items)?;
        let [left, right] = [left, right].map(|item| match item {
            Item::Word(word) => support(word),
            Item::Table(_) => {
                let said = SupportKeys { number: &|key| item.number(key), text: &|key| item.text(key) };
                self.elastic(path, &said)
            }
        });
        Some([left?, right?])
    }

    /// A support with springs and dashpots.
    fn elastic(&mut self, path: &str, said: &SupportKeys<'_>) -> Option<Support> {
        let [deflection, rotation] = MOTIONS.map(|[word, spring, dashpot]| {
            let (stiffness, damping) = ((said.number)(spring), (said.number)(dashpot));
            match ((said.text)(word), stiffness.or(damping)) {
                (Some(_), Some(_)) => {
                    let given = if stiffness.is_some() { spring } else { dashpot };
                    let rule = format!("{word} and {given} both determine how the {word} is held");
                    self.error(path, rule, "keep one of them");
                    None
                }
                (Some("fixed"), None) => Some(Hold::Fixed),
                (_, None) => Some(Hold::Free),
                (None, Some(_)) => {
                    Some(Hold::Spring { stiffness: stiffness.unwrap_or(0.0), damping: damping.unwrap_or(0.0) })
                }
            }
        });
        Some(Support::Elastic { deflection: deflection?, rotation: rotation? })
    }

    /// The supports between the ends, with their positions.
    pub(super) fn inner_supports(&mut self, beam: &str, span: Option<f64>) -> Option<Vec<InnerSupport>> {
        let group = format!("{beam}.support");
        let mut places: Vec<(f64, String)> = Vec::new();
        let mut of = |resolver: &mut Self, name: &str| {
            let path = format!("{group}.{name}");
            let (at, support) = (resolver.place(&path, span), resolver.inner_support(&path));
            let (at, span) = (at?, span?);
            let rule = if at <= SAME_PLACE * span || at >= span * (1.0 - SAME_PLACE) {
                "must be between the ends of the beam, which are held by its key supports".to_owned()
            } else if let Some((_, other)) = places.iter().find(|(x, _)| (x - at).abs() <= SAME_PLACE * span) {
                format!("the support `{other}` is at the same position")
            } else {
                places.push((at, name.to_owned()));
                return Some(InnerSupport::new(at, support?));
            };
            resolver.error(&format!("{path}.at"), rule, "give another position along the beam, from its left end");
            None
        };
        let all: Vec<_> = self.doc.names(&group).into_iter().map(|name| of(self, name)).collect();
        all.into_iter().collect()
    }

    fn inner_support(&mut self, path: &str) -> Option<Support> {
        let doc = self.doc;
        let at = |key: &str| format!("{path}.{key}");
        let written = |key: &&str| doc.has(&at(key)) || doc.is_refused(&at(key));
        let by_parts = MOTIONS.iter().flatten().find(|key| written(key));
        match (written(&"kind"), by_parts) {
            (true, Some(key)) => {
                self.error(&at(key), "kind already determines how the beam is held", "keep one of them");
                None
            }
            (true, None) => support(doc.text(&at("kind"))?),
            (false, Some(_)) => {
                let said = SupportKeys { number: &|key| doc.quantity(&at(key)), text: &|key| doc.text(&at(key)) };
                self.elastic(path, &said)
            }
            (false, None) => {
                let remedy = "add kind = \"pinned\", or a spring such as spring = \"1 kN/m\"";
                self.error(path, "the kind of support is missing", remedy);
                None
            }
        }
    }

    /// A position on the beam, given by the key `at`.
    fn place(&mut self, path: &str, span: Option<f64>) -> Option<f64> {
        let key = format!("{path}.at");
        let (at, span) = (self.quantity(&key)?, span?);
        if at > span {
            let rule = format!("{at} m lies outside the span [0, {span}] m");
            self.error(&key, rule, "give a place along the beam, from its left end");
            return None;
        }
        Some(at)
    }

    /// The masses that the beam carries.
    pub(super) fn lumps(&mut self, beam: &str, span: Option<f64>) -> Option<Vec<Lump>> {
        let group = format!("{beam}.mass");
        let of = |resolver: &mut Self, name: &str| {
            let path = format!("{group}.{name}");
            let x = resolver.place(&path, span);
            let mass = resolver.quantity(&format!("{path}.mass"));
            let inertia = resolver.quantity(&format!("{path}.inertia"));
            Some(Lump::new(x?, mass?).with_inertia(inertia?))
        };
        let all: Vec<_> = self.doc.names(&group).into_iter().map(|name| of(self, name)).collect();
        all.into_iter().collect()
    }

    /// The number of elements, and the positions of the nodes if they aren't uniform.
    pub(super) fn mesh(&mut self, beam: &str, span: Option<f64>) -> Option<(usize, Vec<f64>)> {
        let at = |key: &str| format!("{beam}.{key}");
        let doc = self.doc;
        if let Some(nodes) = doc.list(&at("nodes")) {
            let other = ["elements", "mesh"].into_iter().find(|key| doc.has(&at(key)) || doc.has_table(&at(key)));
            if let Some(other) = other {
                self.error(&at(other), "nodes already determine the elements", "keep one of them");
                return None;
            }
            let nodes = self.nodes(&at("nodes"), nodes, span?)?;
            return Some((nodes.len() - 1, nodes));
        }
        if doc.is_refused(&at("nodes")) {
            return None;
        }
        let elements = doc.integer(&at("elements")).and_then(|elements| usize::try_from(elements).ok());
        let elements = self.required(&at("elements"), elements);
        if !doc.has_table(&at("mesh")) {
            return Some((elements?, Vec::new()));
        }
        let (towards, ratio) = (self.quantity(&at("mesh.towards")), self.number(&at("mesh.ratio")));
        let (elements, span, towards, ratio) = (elements?, span?, towards?, ratio?);
        if towards > span {
            let rule = format!("{towards} m lies outside the span [0, {span}] m");
            self.error(&at("mesh.towards"), rule, "give a place along the beam, from its left end");
            return None;
        }
        Some((elements, graded(span, elements, towards, ratio)))
    }

    /// Nodes as given: in ascending order, from end to end.
    fn nodes(&mut self, path: &str, nodes: &[f64], span: f64) -> Option<Vec<f64>> {
        let same = |x: f64, y: f64| (x - y).abs() <= SAME_PLACE * span;
        let rule = match nodes {
            [first, .., last] if !same(*first, 0.0) || !same(*last, span) => {
                format!("they extend from {first} m to {last} m, but must extend from 0 m to the span, {span} m")
            }
            [_, .., _] => match nodes.windows(2).find(|pair| pair[1] <= pair[0]) {
                Some(pair) => format!("must rise: {} m follows {} m", pair[1], pair[0]),
                None => {
                    let mut nodes = nodes.to_vec();
                    let last = nodes.len() - 1;
                    (nodes[0], nodes[last]) = (0.0, span);
                    return Some(nodes);
                }
            },
            _ => format!("at least two are needed, got {}", nodes.len()),
        };
        self.error(path, rule, "give the places of all nodes from the left end to the right end");
        None
    }
}

fn support(word: &str) -> Option<Support> {
    match word {
        "pinned" => Some(Support::Pinned),
        "clamped" => Some(Support::Clamped),
        "guided" => Some(Support::Guided),
        "free" => Some(Support::Free),
        _ => None,
    }
}

/// Nodes of elements whose length increases linearly with the distance from a position, up to
/// `ratio` times that at the position. With a length h(d) = h₀(1 + a d), ∫dx/h = ln(1 + a d)/a is
/// the number of elements; each side of the position gets a whole number.
fn graded(span: f64, elements: usize, towards: f64, ratio: f64) -> Vec<f64> {
    let sides = [towards, span - towards];
    let a = (ratio - 1.0) / sides[0].max(sides[1]);
    let count = |distance: f64| if a == 0.0 { distance } else { (a * distance).ln_1p() / a };
    let distance = |count: f64| if a == 0.0 { count } else { (a * count).exp_m1() / a };
    let [left, right] = sides.map(count);
    let share = (elements as f64 * left / (left + right)).round() as usize;
    // A side of zero length has none, any other at least one.
    let least = usize::from(left > 0.0);
    let n = share.clamp(least, elements.saturating_sub(usize::from(right > 0.0)).max(least));
    let part = |k: usize, of: usize, whole: f64| distance(whole * (k as f64 / of as f64));
    let mut nodes: Vec<f64> = (0..n).rev().map(|k| towards - part(k + 1, n, left)).collect();
    nodes.push(towards);
    let rest = elements.saturating_sub(n).max(usize::from(right > 0.0));
    nodes.extend((1..=rest).map(|k| towards + part(k, rest, right)));
    let last = nodes.len() - 1;
    (nodes[0], nodes[last]) = (0.0, span);
    nodes
}

#[cfg(test)]
mod tests {
    use super::graded;

    #[test]
    fn a_graded_mesh_is_short_where_it_should_be() {
        for (towards, ratio) in [(0.3, 4.0), (0.0, 10.0), (1.0, 3.0), (0.5, 1.0)] {
            let nodes = graded(1.0, 40, towards, ratio);
            assert_eq!((nodes.len(), nodes[0], nodes[40]), (41, 0.0, 1.0), "{towards}");
            let lengths: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            // Lengths are means over elements, so the quotient of the extreme ones stays a little
            // below.
            assert!(
                (0.85 * ratio..=1.0001 * ratio).contains(&(longest / shortest)),
                "{towards}: {}",
                longest / shortest
            );
            let near = nodes.iter().position(|x| *x == towards).unwrap();
            assert!(lengths[near.saturating_sub(1)..(near + 1).min(40)].iter().any(|l| *l <= 1.001 * shortest));
        }
        assert_eq!(graded(1.0, 1, 0.5, 2.0), [0.0, 0.5, 1.0]);
        assert_eq!(graded(2.0, 1, 0.0, 2.0), [0.0, 2.0]);
    }
}
