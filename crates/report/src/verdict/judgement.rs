//! What became of a block, from what was seen of it up to the end of the run (`docs/verdict.md`).

use super::lying::Side;
use super::watch::Watched;
use super::{BEGAN_TO_TIP, BodyVerdict, FLAT, Fate, Fates, Going, ROCKED, SLID, Seen, TUMBLED, Way};
use teeter_integrator::{RockingMonitor, State};
use teeter_scenario::scene::{BlockScene, Placement};
use teeter_scenario::simulation::Layout;

/// What is tilted by no more than this part of its last peak has come down from it.
const DOWN: f64 = 0.1;

impl Seen {
    pub(super) fn verdict(
        &self,
        watched: &Watched,
        (number, block): (usize, &BlockScene),
        layout: &Layout,
        (start, state): (f64, &State),
        (rocking, fell): (Option<&RockingMonitor>, Option<f64>),
    ) -> BodyVerdict {
        let rests = Fates::rests(self, watched, state.t);
        let spin = state.v[layout.blocks[number].range.start + 2];
        let overturned = self.beyond.filter(|(_, way)| {
            let comes_back = || {
                let edge = self.stance(watched).map(|stance| stance.edge(*way));
                edge.is_some_and(|edge| watched.comes_back(edge, *way, self.angle, spin))
            };
            self.fallen || rests.is_some() || !comes_back()
        });
        // With its column it overturned before it was past its own point of no return.
        let with_column = self.column.and_then(|column| column.overturned(spin, rests.is_some()));
        let overturned = match (overturned, with_column) {
            (Some((t, way)), Some((with_column, same))) if way == same => Some((t.min(with_column), way)),
            (alone, with_column) => alone.or(with_column),
        };
        let place = watched.place(layout, number, state);
        let stays_up = overturned.is_none() && fell.is_none();
        let displaced = self.stood.zip(place).map(|(from, to)| to - from).filter(|_| stays_up);
        // What began in flight, or flies at the end, turns about its mass centre: no foot says where it is.
        let began_in_flight = self.stands_from != Some(start);
        let flown =
            Some(watched.centre(layout, number, state) - self.released).filter(|_| stays_up && watched.feet.is_some());
        let slides = Some(&self.slides).filter(|_| stays_up && self.touched.any());
        // What fell from its place slid out of it as it did: where the one ends and the other begins isn't told.
        let slid = match overturned {
            Some(_) if self.touched.any() => self.slid_before,
            _ => slides.map(|slides| [slides.at(), slides.in_all()]),
        };
        let least = SLID * watched.base();
        let has_slid = slides.is_some_and(|slides| slides.most() >= least);
        let to_and_fro = slides.filter(|slides| slides.is_to_and_fro());
        // One that has come down on a corner and can't turn over any more rocks, though it hasn't settled yet.
        let settling = self.settling.filter(|settling| state.t - settling.since >= FLAT * watched.still_time);
        let part = self.part.or(settling.map(|settling| settling.part));
        let lately = |last: f64| state.t - last < FLAT * watched.still_time;
        let rocked = match settling {
            Some(settling) if self.part.is_none() => settling.rocked.is_some_and(lately),
            // What swings no more, though it isn't still, stands, or slides, or leans on others in a pile that trembles.
            _ => part.is_some_and(|part| part >= ROCKED) && self.swung.is_none_or(|(last, _)| lately(last)),
        };
        let peak = rocking.and_then(|monitor| {
            let of_crossings = || monitor.peaks().last().copied();
            let largest = || Some(monitor.extreme()).filter(|peak| peak.phi != 0.0);
            monitor.turned().or_else(of_crossings).or_else(largest)
        });
        // In flight it did not rock.
        let since = self.stands_from.or(settling.map(|settling| settling.since));
        let peak = peak.filter(|peak| since.is_none_or(|since| peak.t >= since));
        let bounces = rests.is_none() && {
            let crossed = rocking.and_then(|monitor| monitor.crossings().last()).map(|crossing| crossing.t);
            self.bounces(watched, layout, number, state, crossed)
        };
        // It has left its beam when that doesn't press on it any more.
        let a_few_steps = 3.5 * state.t / state.step.max(1) as f64;
        let touches_beam = self.pressed.is_some_and(|last| state.t - last < a_few_steps);
        let left =
            self.out.map(|(t, way)| (if touches_beam { t } else { self.pressed.map_or(t, |last| last.max(t)) }, way));
        // On springs a block leans to and fro without rocking.
        let stands_on_both = watched.on_springs
            && watched.feet.is_some()
            && self.lifted.or(self.stands_from).is_some_and(|last| !lately(last));
        let (what, t, way) = match (overturned, left, self.sunk, rests) {
            (Some((t, way)), ..) => (Fate::Overturned, Some(t), Some(way)),
            (None, Some((t, way)), ..) => (Fate::Left, Some(t), Some(way)),
            (None, None, Some(t), _) => (Fate::Sunk, Some(t), None),
            _ if fell.is_some() => (Fate::Fell, fell, None),
            (None, None, None, Some(t)) if has_slid => (Fate::Slid, Some(t), None),
            (None, None, None, Some(t)) => (Fate::Rests, Some(t), None),
            _ if bounces => (Fate::Moves, None, None),
            _ if rocked && !stands_on_both => (Fate::Rocks, peak.map(|peak| peak.t), None),
            _ if has_slid => (Fate::Slid, None, None),
            _ => (Fate::Moves, None, None),
        };
        let side_on = |slope: f64| Side::below(block, watched.outline.as_ref()?, self.angle - slope);
        // What stands on a block that leans lies flat on that.
        let side = || side_on(watched.slope(&state.q)).or_else(|| side_on(watched.turn(layout, number, state)));
        let lies_on = rests.and_then(|_| side());
        let leans = rests.is_some() && lies_on.is_none() && watched.outline.is_some();
        let turned = self.angle - self.start[2];
        // Where pieces of a profile meet, a base goes a little less far than its feet. What comes down turns over as it does.
        let apart = if watched.carrier.is_terrain() || began_in_flight { watched.base() } else { least };
        let elsewhere = if began_in_flight { flown } else { displaced }
            .filter(|at| slides.is_some_and(|slides| (at - slides.at()).abs() >= apart));
        // Hops, which its slides leave out, may have taken it there and back.
        let stays_near = !began_in_flight && displaced.is_some() && elsewhere.is_none();
        // Which turn it made before and which after isn't told.
        let turns_as_it_falls = matches!(what, Fate::Overturned | Fate::Left);
        let is_free = matches!(block.placement, Placement::Free { .. });
        let may_tumble = is_free && !watched.is_round && !turns_as_it_falls;
        let tumbled = self.began.filter(|_| may_tumble).map(|_| turned);
        let tilt = watched.against_carrier(layout, number, &state.q);
        let turns_on = |monitor: &&RockingMonitor| {
            let way = Way::of(tilt);
            way.sign() * watched.velocity(layout, number, state)[2] > 0.0 && monitor.extreme().phi.abs() <= tilt.abs()
        };
        // A block that rides on another one that rocks is tilted against it by rounding.
        let began_to_tip = |monitor: &&RockingMonitor| {
            let alpha = self.stance(watched).map_or(0.0, |stance| 0.5 * (stance.left.top - stance.right.top));
            monitor.extreme().phi.abs() >= BEGAN_TO_TIP * alpha
        };
        let not_upright = rocking.filter(|monitor| [Fate::Rocks, Fate::Moves].contains(&what) && monitor.count() == 0);
        // One that stands on a beam that rings, or in a pile that trembles, may be still for an instant.
        let has_stopped = self.slides.went().is_some_and(|last| !lately(last));
        let has_stood = part.is_some() && !rocked && has_stopped && self.swung.is_some_and(|(last, _)| !lately(last));
        let moves = what == Fate::Moves && self.still.is_none();
        let rides = what == Fate::Moves && self.rides(watched, least);
        let going = moves.then(|| self.going(watched, layout, number, state)).flatten();
        let going = going.or(rides.then_some(Going::Rides));
        let going = going.or((moves && stands_on_both && rocked).then_some(Going::Vibrates));
        let for_an_instant = self.still.is_some_and(|since| state.t - since < watched.still_time);
        let q = &state.q[layout.blocks[number].range.clone()];
        // What swings is still at its peaks only.
        let has_sat_down = |since: f64| {
            let peak = peak.filter(|peak| peak.t < since);
            peak.is_some_and(|peak| watched.turned(layout, number, state).abs() < DOWN * peak.phi.abs())
        };
        let stopped_swinging = what == Fate::Rocks && self.still.is_some_and(has_sat_down);
        // What swings stands still twice a period.
        let carrier_moves = || self.carried.is_some_and(lately);
        // Where what carries it is shaken, it may slide on.
        let stopped = what == Fate::Slid
            && rests.is_none()
            && (self.still.is_none() || (for_an_instant && carrier_moves()))
            && state.t >= watched.driven_until
            && has_stopped;
        let turning = not_upright.filter(|_| what == Fate::Rocks || (moves && going.is_none())).filter(turns_on);
        // What stands on a beam that bends slowly turns with it.
        let turns = |_: &&RockingMonitor| what == Fate::Rocks || part.is_some_and(|part| part >= BEGAN_TO_TIP);
        let tips = turning.filter(turns).filter(began_to_tip).map(|_| Way::of(tilt));
        let on_its_way = not_upright.filter(|_| what == Fate::Rocks || tips.is_some()).filter(began_to_tip);
        let stands = moves && part.is_some() && !rocked && (has_stopped || self.slides.most() < 0.1 * least);
        let stands = stands || (what == Fate::Moves && has_stood && for_an_instant);
        let trembles = || (stands && turning.is_none()).then_some(Going::Trembles);
        // It slips by less than is told, but does so all the time.
        let chatters = moves
            && part.is_some()
            && turning.is_none()
            && !rocked
            && self.touched.chatters(state.t - FLAT * watched.still_time);
        let going = going.or_else(trembles).or(chatters.then_some(Going::Chatters));
        let rocks_on = || {
            Side::below(block, watched.outline.as_ref()?, self.stance(watched)?.flat).filter(|_| what == Fate::Rocks)
        };
        let stays = stopped || self.still.is_some() || going.is_some_and(Going::stays);
        let stands_on = if stays { side() } else { rocks_on() }.filter(|_| rests.is_none());
        // What rests on its beam from the start may have moved with it; where supports move it is told to stand on these.
        let moved = rests != Some(start) || (self.unmoved != Some(start) && watched.driven_until == 0.0);
        let is_here = matches!(what, Fate::Rests | Fate::Moves) && moved && !began_in_flight;
        // What rests on a beam that goes along its axis goes with it.
        let goes_along = |beam: usize| {
            let place = &layout.beams[beam];
            place.axial_displacement_at(&state.q[place.range.clone()], 0.0).abs() >= least
        };
        let taken_along = rests == Some(start) && watched.carrier.beam().is_some_and(goes_along);
        let before = self.rolled_before.filter(|_| matches!(what, Fate::Left | Fate::Fell));
        let beam = |when: bool| watched.carrier.beam().filter(|_| when).map(|beam| layout.beams[beam].name.clone());
        BodyVerdict {
            start,
            body: layout.blocks[number].name.clone(),
            what,
            t,
            way,
            fell_at: fell,
            overturned_at: overturned.map(|(t, _)| t),
            rests_from: rests,
            leans_at: leans.then_some(tilt),
            lies_on,
            stands_on,
            slid: slid.map(|[at, _]| at),
            slid_in_all: slid.map(|[_, in_all]| in_all),
            farthest: slides.and_then(|slides| slides.farthest(least)),
            slid_to: None,
            farthest_to: None,
            displaced,
            has_slid,
            elsewhere,
            flown: flown.filter(|at| at.abs() >= if began_in_flight { watched.base() } else { least }),
            began_in_flight,
            rolled: before.as_ref().unwrap_or(&self.rolling).told(
                watched,
                watched.centre(layout, number, state) - self.released,
                turned,
            ),
            rolled_since: before.as_ref().and_then(|before| self.rolling.since(before, watched)),
            goes_below: before
                .filter(|_| rests.is_none() && self.goes_along(watched, state.t))
                .map(|_| if self.rolling.rolls { Going::Rolls } else { Going::Slides }),
            to_and_fro: to_and_fro.map(|slides| if stays_near { self.been } else { slides.reached() }),
            is_driven: state.t < watched.driven_until,
            stopped,
            speed: (what == Fate::Slid && rests.is_none() && self.still.is_none() && !stopped).then(|| {
                let [vx, vy, _] = watched.velocity(layout, number, state);
                vx.hypot(vy)
            }),
            max_phi_over_alpha: part,
            last_peak: peak.filter(|_| what == Fate::Rocks).map(|peak| peak.phi),
            against: watched.against(layout, number, &state.q),
            still_from: self.still.filter(|_| rests.is_none() && !stopped),
            stopped_swinging,
            has_landed: self.touched.has_landed(),
            stands_from: since,
            turned: (turns_as_it_falls && !watched.is_round && turned.abs() >= TUMBLED).then_some(turned.abs()),
            is_carried: rests.is_some() && {
                let [vx, vy, spin] = watched.carrier.base_velocity([q[0], q[1]], layout, state);
                // A record may end with the run.
                state.t < watched.driven_until + watched.still_time
                    || vx.hypot(vy) + watched.reach * spin.abs() > watched.still_speed
            },
            tumbled: tumbled.filter(|turn| turn.abs() >= TUMBLED),
            on_its_way: on_its_way.map(|_| tilt),
            on_what_moves: watched.carrier.word().filter(|_| {
                // What rides on a driven block is told to stand on it.
                let is_told = going == Some(Going::Rides) && watched.carrier.is_by_block();
                (stopped || going.is_some_and(|going| going.stays() || going == Going::Bounces))
                    && !is_told
                    && carrier_moves()
            }),
            going,
            stopped_rocking: self
                .swung
                .map(|(last, _)| last)
                .filter(|_| going == Some(Going::Chatters) || (going == Some(Going::Trembles) && has_stood))
                .filter(|_| part.is_some_and(|part| part >= ROCKED)),
            tips,
            unmoved_from: self.unmoved.filter(|since| rests.is_some() && state.t - since >= watched.still_time),
            stood_on: beam(taken_along || (is_here && self.never_moved(watched, least))),
            left_beam: beam(what == Fate::Left),
            fell_off: (what == Fate::Overturned)
                .then(|| watched.carrier.below_an_end([q[0], q[1]], watched.reach, layout, &state.q))
                .flatten()
                .map(|(way, beam)| (way, layout.beams[beam].name.clone())),
            aside: Some(watched.centre(layout, number, state) - self.released)
                .filter(|at| what == Fate::Overturned && way.is_some_and(|way| way.sign() * at >= least)),
            touches_beam: what == Fate::Left && touches_beam,
            past_edge: self.past_edge,
            overturned_with: None,
            turns_with: None,
            in_column: false,
            column: None,
        }
    }
}
