//! The network of contact forces in the moving picture: what each pair of bodies exchanged between two
//! pictures, summed over its contact points from the impulses that `contacts.csv` has.

use super::frames::Entered;
use serde::{Deserialize, Serialize};
use teeter_integrator::Contact;

/// What a pair of bodies exchanged over some time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Link {
    /// The number of the pair in the model.
    pub(crate) pair: u32,
    /// Impulse on its first body, in the world's directions, N·s.
    pub(crate) impulse: [f64; 2],
    /// Its normal impulses, and these times the places where they act, in the first body's own
    /// coordinates, N·s and N·s·m.
    weight: f64,
    moment: [f64; 2],
}

impl Link {
    fn of(contact: &Contact<2>) -> Self {
        let point = contact.sides[0].point;
        let impulse = contact.frame.transpose() * contact.p;
        Self {
            pair: contact.id.pair(),
            impulse: [impulse[0], impulse[1]],
            weight: contact.p[0],
            moment: [contact.p[0] * point[0], contact.p[0] * point[1]],
        }
    }

    fn take(&mut self, other: &Self) {
        for k in 0..2 {
            self.impulse[k] += other.impulse[k];
            self.moment[k] += other.moment[k];
        }
        self.weight += other.weight;
    }

    /// The centre of pressure, in the first body's own coordinates, m: for points on a common plane
    /// the resultant passes through it, as friction acts within the plane. `None` without a normal
    /// impulse.
    pub(crate) fn place(&self) -> Option<[f64; 2]> {
        (self.weight > 0.0).then(|| self.moment.map(|moment| moment / self.weight))
    }
}

/// Of some blocks, those through which a force goes on: of which two forces, opposed to each other, hold each of them up, as of a drum of a column. Their lines go
/// straight from one centre of pressure to the other; by the block's centre they would be a zigzag that no force has. `links` are the blocks of each
/// pair, and the force on the first one.
pub(crate) fn passes_on(blocks: usize, links: &[(usize, Option<usize>, [f64; 2])]) -> Vec<bool> {
    let mut forces: Vec<Vec<[f64; 2]>> = vec![Vec::new(); blocks];
    for (block, other, force) in links {
        forces[*block].push(*force);
        if let Some(other) = other {
            forces[*other].push(force.map(|x| -x));
        }
    }
    let is_opposed = |[a, b]: [[f64; 2]; 2]| cosine(a, b) < -OPPOSED;
    forces.iter().map(|forces| <[[f64; 2]; 2]>::try_from(&forces[..]).is_ok_and(is_opposed)).collect()
}

/// That of the angle between two forces: -1 of those that press against each other, 1 of two that bear a block together, as the posts of a lintel.
pub(super) fn cosine(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) / (a[0].hypot(a[1]) * b[0].hypot(b[1]))
}

/// The cosine of the largest angle by which opposed forces may be off.
const OPPOSED: f64 = 0.5;

/// Adds links, by the number of their pair, to others that are in its order.
fn join(into: &mut Vec<Link>, links: &[Link]) {
    for link in links {
        match into.binary_search_by_key(&link.pair, |own| own.pair) {
            Ok(at) => into[at].take(link),
            Err(at) => into.insert(at, *link),
        }
    }
}

/// The links before each picture that is kept, since the one before it.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Network {
    /// Those of all pictures in a row.
    links: Vec<Link>,
    /// Where those of each picture end.
    ends: Vec<usize>,
    /// Those since the last picture, by their pairs.
    pending: Vec<Link>,
}

/// Most links in all pictures: at some eight bytes each they are below 2 MB of a page.
const MOST_LINKS: usize = 200_000;

impl Network {
    /// A network of so many pictures of so many blocks, with memory for what they usually have.
    pub(crate) fn new(pictures: usize, blocks: usize) -> Self {
        // A block in a pile touches four others, each of which shares the link.
        let usual = (3 * blocks * pictures).min(MOST_LINKS);
        Self { links: Vec::with_capacity(usual), ends: Vec::with_capacity(pictures), pending: Vec::new() }
    }

    /// Takes the contacts of a step, or of a part of it, in.
    #[inline]
    pub(crate) fn add(&mut self, contacts: &[Contact<2>]) {
        // In order of identity they mostly come in the order of the links.
        let mut at = 0;
        for contact in contacts.iter().filter(|contact| contact.p[0] != 0.0 || contact.p[1] != 0.0) {
            let pair = contact.id.pair();
            while self.pending.get(at).is_some_and(|link| link.pair < pair) {
                at += 1;
            }
            let link = Link::of(contact);
            match self.pending.get_mut(at).filter(|own| own.pair == pair) {
                Some(own) => own.take(&link),
                None => join(&mut self.pending, &[link]),
            }
        }
    }

    /// Follows the pictures: what became of the one at the end of the last step.
    #[inline]
    pub(crate) fn follow(&mut self, entered: Entered) {
        if entered.halved {
            self.halve();
        }
        if entered.kept {
            self.links.append(&mut self.pending);
            self.ends.push(self.links.len());
        }
    }

    /// Whether there are so many links that every second picture has to go.
    pub(crate) fn is_full(&self) -> bool {
        self.links.len() > MOST_LINKS && self.ends.len() > 2
    }

    /// The links before a picture.
    fn before(&self, picture: usize) -> &[Link] {
        let start = picture.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.links[start..self.ends[picture]]
    }

    /// Follows pictures of which every second has gone.
    pub(crate) fn halve(&mut self) {
        let (mut joined, mut written, mut start) = (Vec::new(), 0, 0);
        let pictures = self.ends.len();
        // What is written never reaches what is still to be read: joined, there are no more of them.
        for picture in 0..pictures {
            let end = self.ends[picture];
            join(&mut joined, &self.links[start..end]);
            start = end;
            if picture.is_multiple_of(2) {
                self.links[written..written + joined.len()].copy_from_slice(&joined);
                written += joined.len();
                self.ends[picture / 2] = written;
                joined.clear();
            }
        }
        self.links.truncate(written);
        self.ends.truncate(pictures.div_ceil(2));
        // Those of a last picture that has gone belong to the next one.
        join(&mut joined, &self.pending);
        std::mem::swap(&mut self.pending, &mut joined);
    }

    /// The links before each of `pictures`, the last of which may be the end of the run.
    pub(crate) fn pictures(&self, pictures: usize) -> impl Iterator<Item = &[Link]> {
        let kept = (0..self.ends.len()).map(|picture| self.before(picture));
        kept.chain(std::iter::once(self.pending.as_slice())).take(pictures)
    }
}

#[cfg(test)]
mod tests {
    use super::super::frames::Frames;
    use super::*;

    fn link(pair: u32, size: f64, place: f64) -> Link {
        Link { pair, impulse: [size, -2.0 * size], weight: size, moment: [size * place, 0.0] }
    }

    /// One pair has an impulse of 1 in each step, another one in every third.
    fn run(capacity: usize, steps: u32) -> (Network, Vec<f64>) {
        let (mut network, mut frames) = (Network::default(), Frames::new(capacity, 0));
        network.follow(frames.enter(0.0, |_| {}));
        for step in 1..=steps {
            if step % 3 == 0 {
                join(&mut network.pending, &[link(1, 1.0, 0.0)]);
            }
            join(&mut network.pending, &[link(7, 1.0, f64::from(step))]);
            let t = f64::from(step);
            network.follow(frames.enter(t, |_| {}));
        }
        frames.end(f64::from(steps), |_| {});
        (network, frames.rows().map(|row| row.0).collect())
    }

    #[test]
    fn forces_go_straight_through_a_drum_and_not_through_a_lintel() {
        // Block 0 on the ground, 1 on 0, 2 on both 1 and 3, which stands on the ground.
        let up = |size: f64| [0.0, size];
        let links = [
            (0, None, up(5.0)),
            (1, Some(0), up(4.0)),
            (2, Some(1), up(3.0)),
            (2, Some(3), up(2.9)),
            (3, None, up(4.0)),
        ];
        assert_eq!(passes_on(4, &links), [true, true, false, true]);
    }

    #[test]
    fn every_impulse_is_in_the_interval_before_its_picture() {
        for steps in [1, 3, 4, 5, 17, 100, 1001] {
            let (network, times) = run(4, steps);
            let pictures: Vec<&[Link]> = network.pictures(times.len()).collect();
            assert_eq!(pictures.len(), times.len());
            assert!(pictures[0].is_empty(), "nothing happened before the start");
            for (links, ends) in pictures[1..].iter().zip(times.windows(2)) {
                let constant = links.iter().find(|link| link.pair == 7).unwrap();
                assert_eq!(constant.weight, ends[1] - ends[0], "{steps} steps: {ends:?}");
                assert_eq!(constant.impulse[1], -2.0 * constant.weight);
                // Its places are the numbers of the steps: their mean is the middle of the interval.
                assert_eq!(constant.place().unwrap()[0], 0.5 * (ends[0] + 1.0 + ends[1]));
                assert!(links.windows(2).all(|two| two[0].pair < two[1].pair));
            }
            let rare: f64 =
                pictures.iter().flat_map(|links| links.iter()).filter(|l| l.pair == 1).map(|l| l.weight).sum();
            assert_eq!(rare, f64::from(steps / 3));
        }
    }
}
