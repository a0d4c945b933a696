//! `teeter run --vtk`: the pictures hold the motion of the tables, and another program reads them.

#![allow(clippy::unwrap_used, clippy::print_stderr)] // a test

use std::path::{Path, PathBuf};
use std::process::Command;

fn run(name: &str, scene: &str, sets: &[&str]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("vtk-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(scene);
    let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
    command.arg("run").arg(scene).arg("--out").arg(&folder).args(["--quiet", "--no-report", "--vtk"]);
    sets.iter().for_each(|set| _ = command.args(["--set", set]));
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    folder
}

/// The numbers of an array of a picture.
fn array(picture: &str, name: &str) -> Vec<f64> {
    let (_, after) = picture.split_once(&format!("Name=\"{name}\"")).unwrap();
    let (_, data) = after.split_once('>').unwrap();
    data.split('<').next().unwrap().split_whitespace().map(|number| number.parse().unwrap()).collect()
}

fn columns(folder: &Path, names: &[&str]) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join("trajectory.csv")).unwrap();
    let heading: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let places: Vec<usize> = names.iter().map(|name| heading.iter().position(|cell| cell == name).unwrap()).collect();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        places.iter().map(|&place| cells[place].parse().unwrap()).collect()
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn pictures_hold_the_motion_of_the_tables() {
    let folder = run("beam", "free-rocking-on-beam.toml", &["time.end=50 ms"]);
    let rows = columns(&folder, &["t", "rocker.x", "rocker.y", "table.w_mid"]);
    let series = std::fs::read_to_string(folder.join("vtk/scene.pvd")).unwrap();
    assert_eq!(series.matches("<DataSet").count(), rows.len());
    for (number, row) in rows.iter().enumerate() {
        assert!(series.contains(&format!("timestep=\"{:?}\" part=\"0\" file=\"picture-{number:04}.vtu\"", row[0])));
        let picture = std::fs::read_to_string(folder.join(format!("vtk/picture-{number:04}.vtu"))).unwrap();
        let points = array(&picture, "Points");
        let (offsets, types) = (array(&picture, "offsets"), array(&picture, "types"));
        assert_eq!(offsets.len(), types.len());
        assert_eq!(array(&picture, "connectivity").len() as f64, *offsets.last().unwrap());
        // The block is a rectangle, so the mean of its corners is its mass centre.
        assert_eq!((types[0], offsets[0]), (7.0, 4.0));
        let mean = |k: usize| (0..4).map(|corner| points[3 * corner + k]).sum::<f64>() / 4.0;
        assert!((mean(0) - row[1]).abs() < 1e-12 && (mean(1) - row[2]).abs() < 1e-12, "picture {number}");
        // Midspan is the middle point of the beam.
        let beam: Vec<&[f64]> = points.chunks(3).skip(4).filter(|point| (point[0] - 0.18).abs() < 1e-9).collect();
        assert!(beam.iter().any(|point| (point[1] - row[3]).abs() < 1e-12), "picture {number}");
    }
    // Over the run the forces have the impulse that stopped the fall: weight, and the change of momentum.
    let velocity = columns(&folder, &["t", "rocker.vy"]);
    let mut impulse = 0.0;
    for number in 1..rows.len() {
        let picture = std::fs::read_to_string(folder.join(format!("vtk/picture-{number:04}.vtu"))).unwrap();
        let force: f64 = array(&picture, "force").chunks(3).map(|force| force[1]).sum();
        impulse += force * (rows[number][0] - rows[number - 1][0]);
    }
    let mass = 0.03 * 0.135 * 0.03 * 2700.0;
    let wanted = mass * (9.81 * 0.05 + velocity.last().unwrap()[1]);
    assert!((impulse - wanted).abs() < 1e-9 * wanted.abs() + 1e-9, "{impulse} {wanted}");
}

#[test]
fn pictures_are_written_as_they_come() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("vtk-early");
    let _ = std::fs::remove_dir_all(&folder);
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
    command.arg("run").arg(scene).arg("--out").arg(&folder).args(["--quiet", "--no-report", "--vtk"]);
    // 100 million steps, a picture after each 50 000.
    let mut child = command.args(["--set", "time.end=10000 s", "--set", "output.every=1 s"]).spawn().unwrap();
    let begin = std::time::Instant::now();
    let second = folder.join("vtk/picture-0001.vtu");
    while !second.exists() && begin.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let ended = child.try_wait().unwrap();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(ended.is_none() && second.exists(), "{ended:?}");
    let picture = std::fs::read_to_string(second).unwrap();
    assert!(picture.ends_with("</VTKFile>\n") && !folder.join("vtk/scene.pvd").exists());
}

#[test]
fn meshio_reads_the_pictures() {
    let python = std::env::var("TEETER_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let python =
        |script: &str, arguments: &[&str]| Command::new(&python).arg("-c").arg(script).args(arguments).output();
    if !python("import meshio", &[]).is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: meshio can't be imported; `pip install meshio`, or name its Python in TEETER_PYTHON");
        return;
    }
    for (name, scene, kinds) in [
        ("arch", "masonry-arch.toml", ["polygon", "vertex"]),
        ("two-span", "two-span-beam.toml", ["line", "line"]),
        ("read", "free-rocking-on-beam.toml", ["polygon", "line"]),
    ] {
        let folder = run(name, scene, &["time.end=10 ms"]);
        let script = "import meshio, sys\n\
            mesh = meshio.read(sys.argv[1])\n\
            assert len(mesh.points) > 0 and mesh.point_data['force'].shape == mesh.points.shape\n\
            kinds = {block.type[:7] for block in mesh.cells}\n\
            assert {sys.argv[2], sys.argv[3]} <= kinds, kinds\n\
            assert sum(len(part) for part in mesh.cell_data['body']) == sum(len(block.data) for block in mesh.cells)\n";
        let picture = folder.join("vtk/picture-0001.vtu");
        let output = python(script, &[picture.to_str().unwrap(), kinds[0], kinds[1]]).unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// A beam that columns take along by friction is written where it lies on them.
#[test]
fn a_beam_that_moves_along_its_axis_is_written_where_it_is() {
    let folder = run("taken-along", "../.ci/scenes/beam-taken-along.toml", &[]);
    let rows = columns(&folder, &["left.x", "left.y"]);
    let last = std::fs::read_dir(folder.join("vtk")).unwrap().count() - 2; // the list, and the first picture
    let points = |number: usize| {
        array(&std::fs::read_to_string(folder.join(format!("vtk/picture-{number:04}.vtu"))).unwrap(), "Points")
    };
    // Three rectangles, then the beam from the left on.
    let left = |number: usize| points(number)[3 * 12];
    let column = rows.last().unwrap()[0] - rows[0][0];
    let went = left(last) - left(0);
    assert!(
        left(0) == 0.0 && column > 0.4 && (went - column).abs() < 1e-3,
        "the beam went {went} m, its columns {column} m"
    );
}
