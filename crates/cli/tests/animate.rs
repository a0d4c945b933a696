//! `teeter run --animate`: the files are read back by decoders.

#![cfg(feature = "animation")]
#![allow(clippy::unwrap_used)] // a test

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder for a test.
fn place(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("animate-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn teeter(folder: &Path, scene: &str, more: &[&str]) -> Output {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(scene);
    let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
    command.current_dir(folder).arg("run").arg(scene).args(["--out", "out", "--no-report"]).args(more);
    command.output().unwrap()
}

fn done(folder: &Path, scene: &str, more: &[&str]) -> String {
    let output = teeter(folder, scene, more);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    said
}

fn refused(folder: &Path, more: &[&str]) -> String {
    let output = teeter(folder, "free-rocking-on-ground.toml", more);
    assert_eq!(output.status.code(), Some(2), "{more:?}");
    assert!(!folder.join("out").exists() || more.contains(&"--force"), "{more:?} has written something");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// What a reader of an animation sees.
struct Film {
    size: [usize; 2],
    /// Each picture as a whole, red, green and blue of each pixel.
    pictures: Vec<Vec<[u8; 3]>>,
    /// How long each is shown, s.
    shown: Vec<f64>,
    forever: bool,
}

impl Film {
    fn of_gif(bytes: &[u8]) -> Self {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        let size = [usize::from(decoder.width()), usize::from(decoder.height())];
        let mut film = Self { size, pictures: Vec::new(), shown: Vec::new(), forever: false };
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            let area = [frame.left, frame.top, frame.width, frame.height].map(usize::from);
            let buffer = frame.buffer.to_vec();
            film.shown.push(f64::from(frame.delay) / 100.0);
            film.add(area, &buffer);
        }
        film.forever = decoder.repeat() == gif::Repeat::Infinite;
        film
    }

    fn of_png(bytes: &[u8]) -> Self {
        let mut decoder = png::Decoder::new(bytes);
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let info = reader.info();
        let size = [info.width as usize, info.height as usize];
        let control = info.animation_control.unwrap();
        let mut film = Self { size, pictures: Vec::new(), shown: Vec::new(), forever: control.num_plays == 0 };
        let mut buffer = vec![0; reader.output_buffer_size()];
        for _ in 0..control.num_frames {
            reader.next_frame(&mut buffer).unwrap();
            let frame = *reader.info().frame_control.as_ref().unwrap();
            let area = [frame.x_offset, frame.y_offset, frame.width, frame.height].map(|px| px as usize);
            film.shown.push(f64::from(frame.delay_num) / f64::from(frame.delay_den));
            film.add(area, &buffer[..4 * area[2] * area[3]]);
        }
        film
    }

    /// Lays a rectangle over the picture before.
    fn add(&mut self, [left, top, width, _]: [usize; 4], rgba: &[u8]) {
        let mut picture = self.pictures.last().cloned().unwrap_or_else(|| vec![[0; 3]; self.size[0] * self.size[1]]);
        for (k, pixel) in rgba.chunks_exact(4).enumerate() {
            if pixel[3] != 0 {
                picture[(top + k / width) * self.size[0] + left + k % width] = [pixel[0], pixel[1], pixel[2]];
            }
        }
        self.pictures.push(picture);
    }

    /// How many pixels of the picture have a colour like this.
    fn count(&self, picture: usize, colour: [u8; 3]) -> usize {
        let near = |pixel: &&[u8; 3]| pixel.iter().zip(colour).all(|(a, b)| a.abs_diff(b) < 3);
        self.pictures[picture].iter().filter(near).count()
    }

    /// The mean place of the pixels of a colour, px.
    fn middle(&self, picture: usize, colour: [u8; 3]) -> [f64; 2] {
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for (k, pixel) in self.pictures[picture].iter().enumerate() {
            if pixel.iter().zip(colour).all(|(a, b)| a.abs_diff(b) < 3) {
                sum = [sum[0] + (k % self.size[0]) as f64, sum[1] + (k / self.size[0]) as f64];
                count += 1.0;
            }
        }
        sum.map(|x| x / count)
    }
}

const BLOCK: [u8; 3] = [0xcf, 0xdf, 0xf2];

#[test]
fn gif_and_png_show_the_motion_with_the_times_asked_for() {
    let folder = place("formats");
    let options = ["--animate-width", "300", "--animate-fps", "30", "--animate-speed", "0.5"];
    let film = |file: &str| {
        let more: Vec<&str> = ["--force", "--animate", file].into_iter().chain(options).collect();
        let said = done(&folder, "free-rocking-on-beam.toml", &more);
        assert!(said.contains(&format!("animation in {file}: 300 × ")), "{said}");
        assert!(said.contains("31 pictures, 2 s, 2 times slower than real time"), "{said}");
        std::fs::read(folder.join(file)).unwrap()
    };
    let bytes = [film("motion.gif"), film("motion.png")];
    let films = [Film::of_gif(&bytes[0]), Film::of_png(&bytes[1])];
    for (film, bytes) in films.iter().zip(&bytes) {
        // 0.5 s at half speed and 30 pictures a second, and the last picture for a second.
        assert_eq!((film.pictures.len(), film.size[0], film.forever), (31, 300, true));
        assert!((film.shown[..30].iter().sum::<f64>() - 1.0).abs() < 0.006 && film.shown[0] > 0.029);
        assert!((film.shown[30] - 1.0).abs() < 0.006, "{:?}", film.shown);
        // The first picture shows the block of 3 cm by 13.5 cm and the beam under it, on white.
        let scale = f64::from(300 - 20) / 0.36;
        let block = film.count(0, BLOCK) as f64 / (0.03 * 0.135 * scale * scale);
        assert!((0.7..1.0).contains(&block), "{block}");
        // Between the supports each column has a dark pixel of the beam.
        let dark = |x: &usize| (100..125).any(|y| film.pictures[0][300 * y + x][0] < 0xb0);
        assert_eq!((15..285).filter(dark).count(), 270);
        assert!(film.count(0, [0xff; 3]) > 20_000);
        assert!(film.pictures.windows(2).filter(|pair| pair[0] != pair[1]).count() > 25);
        assert!(bytes.len() < 60_000, "{} bytes", bytes.len());
    }
    // Both hold the same pictures.
    assert!(films[0].pictures == films[1].pictures);
}

#[test]
fn a_block_stands_in_each_picture_where_it_is_at_that_time() {
    let folder = place("places");
    // A fall of 0.1 s from 6 cm above the ground: y = −g t²/2.
    let scene = folder.join("drop.toml");
    let text = r#"
        time = { end = "0.1 s", step = "1 ms" }
        ground = {}
        material.wood = { density = "600 kg/m^3" }
        block.cube = { material = "wood", width = "10 cm", height = "10 cm", depth = "10 cm", position = ["0 m", "11 cm"] }
        contact.floor = { between = ["cube", "ground"], friction = 0.4 }
    "#;
    std::fs::write(&scene, text).unwrap();
    done(&folder, scene.to_str().unwrap(), &["--animate", "drop.gif", "--animate-speed", "0.1", "--animate-fps", "10"]);
    let film = Film::of_gif(&std::fs::read(folder.join("drop.gif")).unwrap());
    assert_eq!(film.pictures.len(), 11);
    let start = film.middle(0, BLOCK);
    // The block takes the width between margins of 24 px, or the height; pixels a metre from its own area.
    let scale = (film.count(0, BLOCK) as f64).sqrt() / 0.1;
    for k in 0..=10 {
        let t = 0.01 * k as f64;
        let [x, y] = film.middle(k, BLOCK);
        let fallen = 0.5 * 9.81 * t * t * scale;
        assert!((x - start[0]).abs() < 0.5 && (y - start[1] - fallen).abs() < 1.0 + 0.01 * fallen, "{k}: {y} {fallen}");
    }
}

#[test]
fn without_a_speed_an_animation_takes_5_to_20_s_and_long_ones_have_at_most_1000_pictures() {
    let folder = place("speeds");
    let said = done(&folder, "free-rocking-on-beam.toml", &["--animate", "a.gif", "--animate-width", "120"]);
    assert!(said.contains("126 pictures, 6 s, 10 times slower than real time"), "{said}");
    let slow = ["--force", "--animate", "a.gif", "--animate-width", "120", "--animate-speed", "0.005"];
    let said = done(&folder, "free-rocking-on-beam.toml", &slow);
    assert!(said.contains("1000 pictures (9.99 a second, as there are at most 1000), 101 s"), "{said}");
    let film = Film::of_gif(&std::fs::read(folder.join("a.gif")).unwrap());
    assert_eq!(film.pictures.len(), 1000);
}

#[test]
fn an_animation_may_stand_in_the_results_and_replaces_nothing_unasked() {
    let folder = place("files");
    let small = ["--animate-width", "120", "--set", "time.end=20 ms", "--set", "time.step=1 ms"];
    let with = |more: &[&'static str]| [more, &small].concat();
    done(&folder, "free-rocking-on-ground.toml", &with(&["--animate", "out/motion.gif"]));
    assert!(folder.join("out/motion.gif").exists());
    done(&folder, "free-rocking-on-ground.toml", &with(&["--force", "--animate", "out/motion.gif"]));
    std::fs::remove_dir_all(folder.join("out")).unwrap();
    std::fs::write(folder.join("mine.gif"), "mine").unwrap();
    assert!(refused(&folder, &["--animate", "mine.gif"]).contains("mine.gif already exists; --force replaces it"));
    assert_eq!(std::fs::read(folder.join("mine.gif")).unwrap(), b"mine");
    assert!(refused(&folder, &["--animate", "nowhere/a.gif"]).contains("there is no folder nowhere"));
    std::fs::create_dir(folder.join("folder.gif")).unwrap();
    assert!(refused(&folder, &["--animate", "folder.gif"]).contains("is a folder, not a file for an animation"));
}

#[test]
fn options_out_of_range_are_refused() {
    let folder = place("options");
    for (more, wanted) in [
        (["--animate", "motion.mp4", "--quiet", ""], "its name must end in .gif, .png or .apng"),
        (["--animate", "a.gif", "--animate-width", "100"], "an animation is 120 to 1920 px wide, got 100"),
        (["--animate", "a.gif", "--animate-fps", "60"], "an animation has 1 to 50 pictures a second, got 60"),
        (["--animate", "a.gif", "--animate-speed", "0"], "times that of the motion, got 0"),
        (["--animate", "a.gif", "--animate-speed", "slow"], "write a number"),
        (["--animate-width", "200", "--quiet", ""], "--animate <FILE>"),
    ] {
        let more: Vec<&str> = more.into_iter().filter(|word| !word.is_empty()).collect();
        let said = refused(&folder, &more);
        assert!(said.contains(wanted), "{said}");
    }
}
