//! The contacts of a smooth motion: each sticks or slides, and its force keeps it so.

use crate::Vector;
use teeter_detect::ContactId;

/// What a contact that presses does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    /// No tangential velocity.
    Stick,
    /// It slides to the side of this sign.
    Slide(f64),
}

impl Mode {
    /// As the state's memory holds it.
    pub(super) fn number(self) -> f64 {
        match self {
            Self::Stick => 0.0,
            Self::Slide(sign) => sign,
        }
    }

    pub(super) fn of(number: f64) -> Self {
        if number == 0.0 { Self::Stick } else { Self::Slide(number.signum()) }
    }
}

/// A contact that presses, with its force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pressing {
    pub(super) id: ContactId,
    pub(super) mode: Mode,
    /// The gap that it keeps: 0, or less where it began in the surface, m.
    pub(super) level: f64,
    pub(super) friction: f64,
    /// Its force on side 0, N.
    pub(super) force: Vector<2>,
    /// The same before friction is shared, N.
    pub(super) alone: Vector<2>,
    /// The weight of its friction among distributions of forces.
    pub(super) weight: f64,
    /// Its relative velocity, m/s.
    pub(super) u: Vector<2>,
    /// That at the start of the phase, m/s.
    pub(super) u_before: Vector<2>,
    /// What its normal acceleration consists of, in size, without contacts, m/s².
    pub(super) scale: f64,
    /// What that consists of, in size, m/s.
    pub(super) speed: f64,
    /// At the start of a step of the method: how far it is from opening and from sliding, and its
    /// velocity along its slide.
    pub(super) start: [f64; 3],
    /// Its acceleration without contacts, m/s².
    pub(super) free: Vector<2>,
    /// Its own entry of H, normal and tangential, 1/kg.
    pub(super) own: [f64; 2],
    /// How far it is from sliding together with those that share its friction.
    pub(super) held: f64,
    /// How far it is to the end of its surface, m.
    pub(super) room: f64,
    /// The same at the start of a step of the method, m.
    pub(super) start_room: f64,
    /// Where its rows are in the stage; `None` where it has none, off the end of its surface.
    pub(super) row: Option<usize>,
}

impl Pressing {
    pub(super) fn new(id: ContactId, mode: Mode, level: f64, friction: f64) -> Self {
        let zero = Vector::zeros();
        Self {
            id,
            mode,
            level,
            friction,
            force: zero,
            alone: zero,
            weight: 1.0,
            u: zero,
            u_before: zero,
            scale: 0.0,
            free: zero,
            speed: 0.0,
            start: [0.0; 3],
            own: [0.0; 2],
            held: f64::INFINITY,
            room: f64::INFINITY,
            start_room: f64::INFINITY,
            row: None,
        }
    }

    /// How far it is from opening: its normal force as an acceleration, in parts of its scale.
    pub(super) fn presses(&self) -> f64 {
        self.force[0] * self.own[0] / self.scale
    }

    /// How far it is from sliding, alike; infinity where it slides.
    pub(super) fn holds(&self) -> f64 {
        match self.mode {
            Mode::Stick => (self.friction * self.force[0] - self.force[1].abs()) * self.own[1] / self.scale,
            Mode::Slide(_) => f64::INFINITY,
        }
    }

    /// Its friction in parts of its normal force; 0 where it sticks, and it isn't known.
    pub(super) fn slope(&self) -> f64 {
        match self.mode {
            Mode::Stick => 0.0,
            Mode::Slide(sign) => -self.friction * sign,
        }
    }

    /// Its velocity along its slide, m/s; infinity where it sticks, or nothing holds it.
    pub(super) fn slides(&self) -> f64 {
        match self.mode {
            Mode::Slide(sign) if self.friction > 0.0 => sign * self.u[1],
            _ => f64::INFINITY,
        }
    }
}
