//! The network of contact forces, picture by picture.

use super::digits;
use crate::page::network::{Link, passes_on};
use crate::page::packed::Packed;
use crate::page::recorder::PageRecorder;
use serde::Serialize;
use teeter_scenario::scene::SupportingBody;

/// The network of contact forces: for each picture the links since the one before, each as the difference of its pair's
/// number in `pairs` from that of the link before, its force in 4095ths of `largest` and the centre of pressure in the
/// first body's own coordinates, in 1000ths of its reach. The difference comes times four, with 1 where the force goes on straight through the first
/// body, and 2 where it does through the other one.
#[derive(Serialize)]
pub(super) struct NetworkData {
    /// The bodies of each pair: block and block, or −1 for ground, −2 for the first beam and so on.
    pub(super) pairs: Vec<(usize, i64)>,
    /// The largest force of each picture, N.
    largest: Vec<f64>,
    links: Vec<String>,
}

/// Steps of a force, and of a place within a body.
const FORCE_STEPS: f64 = 4095.0;
const PLACE_STEPS: f64 = 1000.0;

pub(super) fn network(recorder: &PageRecorder) -> NetworkData {
    let scenery = &recorder.scenery;
    let times: Vec<f64> = recorder.kept.frames.rows().map(|(t, _)| t).collect();
    let pictures = || recorder.kept.network.pictures(times.len());
    let mut numbers: Vec<u32> = pictures().flatten().map(|link| link.pair).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.retain(|pair| scenery.bodies_of(*pair).is_some());
    let bodies = numbers.iter().filter_map(|pair| {
        let (block, other) = scenery.bodies_of(*pair)?;
        let other = match other {
            SupportingBody::Block(other) => other as i64,
            SupportingBody::Ground => -1,
            SupportingBody::Beam(beam) => -2 - beam as i64,
        };
        Some((block, other))
    });
    let mut data = NetworkData { pairs: bodies.collect(), largest: Vec::new(), links: Vec::new() };
    for (picture, links) in pictures().enumerate() {
        let duration = picture.checked_sub(1).map_or(1.0, |before| times[picture] - times[before]);
        let size = |link: &Link| link.impulse[0].hypot(link.impulse[1]) / duration;
        let largest = links.iter().map(size).fold(0.0, f64::max);
        let (mut packed, mut before) = (Packed::default(), 0);
        let drawn = links.iter().filter_map(|link| {
            let (block, other) = scenery.bodies_of(link.pair).filter(|_| size(link) * FORCE_STEPS >= 0.5 * largest)?;
            Some((block, if let SupportingBody::Block(other) = other { Some(other) } else { None }, link.impulse))
        });
        let passes_on = passes_on(scenery.blocks.len(), &drawn.collect::<Vec<_>>());
        for link in links {
            let (Ok(number), Some(place)) = (numbers.binary_search(&link.pair), link.place()) else { continue };
            let force = (size(link) / largest * FORCE_STEPS).round() as u64;
            if force == 0 {
                continue;
            }
            let (block, other) = data.pairs[number];
            let through = |block: usize| passes_on[block] && !scenery.blocks[block].driven;
            let flags = [through(block), usize::try_from(other).is_ok_and(through)].map(u64::from);
            packed.push(4 * (number - before) as u64 + flags[0] + 2 * flags[1]);
            before = number;
            packed.push(force);
            let reach = scenery.blocks[block].reach;
            place.into_iter().for_each(|x| packed.push_signed((x / reach * PLACE_STEPS).round() as i64));
        }
        data.largest.push(digits(largest));
        data.links.push(packed.text());
    }
    data
}
