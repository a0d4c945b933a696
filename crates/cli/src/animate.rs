//! `teeter run --animate`: its options, and what is said of the file.

use std::path::{Path, PathBuf};
use teeter_report::{Animation, AnimationFormat, AnimationInfo, shortest};

/// The options of an animation.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Animate {
    /// Also write the motion as an animation to FILE: `.gif`, which every program shows, or `.png` or `.apng`, an animated PNG
    /// for browsers
    #[arg(long = "animate", value_name = "FILE", value_parser = file)]
    file: Option<File>,
    /// Width of the animation in pixels; the height follows from the scene
    #[arg(long = "animate-width", value_name = "PX", default_value = "720", value_parser = width, requires = "file")]
    width: u32,
    /// Pictures of the animation a second; at most 1000 in all
    #[arg(long = "animate-fps", value_name = "N", default_value = "25", value_parser = rate, requires = "file", allow_hyphen_values = true)]
    rate: f64,
    /// Speed of the animation: 1 is real time, 0.1 ten times slower (default: real time if that takes 5 to 20 s, else so much
    /// slower or faster)
    #[arg(long = "animate-speed", value_name = "X", value_parser = speed, requires = "file", allow_hyphen_values = true)]
    speed: Option<f64>,
}

/// A file for an animation.
#[derive(Clone, Debug)]
struct File {
    path: PathBuf,
    format: AnimationFormat,
}

fn file(text: &str) -> Result<File, String> {
    let path = PathBuf::from(text);
    let format = AnimationFormat::of_file(&path);
    format.map(|format| File { path, format }).ok_or_else(|| "its name must end in .gif, .png or .apng".to_owned())
}

/// An animation by which options are tried, one by one.
fn any() -> Animation {
    Animation::new(AnimationFormat::Gif)
}

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "write a number".to_owned())
}

fn width(text: &str) -> Result<u32, String> {
    let px = text.trim().parse().map_err(|_| "write a whole number of pixels, such as 720".to_owned())?;
    any().width(px).map(|_| px).map_err(|error| error.to_string())
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = number(text)?;
    any().rate(rate).map(|_| rate).map_err(|error| error.to_string())
}

fn speed(text: &str) -> Result<f64, String> {
    let speed = number(text)?;
    any().speed(speed).map(|_| speed).map_err(|error| error.to_string())
}

impl Animate {
    /// The file, if there is to be one, and what goes into it.
    pub(crate) fn file(&self) -> Option<(&Path, Animation)> {
        let File { path, format } = self.file.as_ref()?;
        // The options were tried when they were read.
        let animation =
            Animation::new(*format).width(self.width).and_then(|animation| animation.rate(self.rate)).ok()?;
        let animation = match self.speed {
            Some(speed) => animation.speed(speed).ok()?,
            None => animation,
        };
        Some((path, animation))
    }
}

/// What is said of an animation that was written.
pub(crate) fn describe(path: &Path, asked: &Animation, made: &AnimationInfo) -> String {
    let [width, height] = made.size;
    let speed = if made.speed < 1.0 {
        format!("{} times slower than real time", shortest(1.0 / made.speed, 3))
    } else if made.speed > 1.0 {
        format!("{} times faster than real time", shortest(made.speed, 3))
    } else {
        "in real time".to_owned()
    };
    let pictures = if made.pictures == 1 { "picture" } else { "pictures" };
    let fewer = if made.rate < asked.pictures_a_second() {
        format!(" ({} a second, as there are at most 1000)", shortest(made.rate, 3))
    } else {
        String::new()
    };
    format!(
        "  animation in {}: {width} × {height} px, {} {pictures}{fewer}, {} s, {speed}",
        path.display(),
        made.pictures,
        shortest(made.seconds, 3),
    )
}
