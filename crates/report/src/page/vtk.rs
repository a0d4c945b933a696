//! Pictures of a run for ParaView and other readers of VTK: a `.vtu` file for each, and a `.pvd` file
//! with their times.
//!
//! Blocks are polygons, beams lines along their deflected axes, contacts points with the mean force
//! since the picture before.

use super::outline::Outline;
use super::recorder::BLOCK_FRAME;
use super::scenery::Scenery;
use crate::{Results, ResultsError, Schedule};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::ControlFlow;
use teeter_detect::ContactId;
use teeter_integrator::{Contact, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// A cell: its kind in VTK, the number of its body, its points.
type Cell = (u8, usize, Vec<usize>);

/// The file that lists the pictures with their times.
pub const VTK_SERIES: &str = "vtk/scene.pvd";

/// Pictures of a run for which no interval is given, and the most of any run.
const PICTURES: f64 = 200.0;
const MOST_PICTURES: f64 = 2000.0;

/// The name of a picture beside the series.
fn picture_name(number: usize) -> String {
    format!("picture-{number:04}.vtu")
}

/// Its path in the folder of the results.
fn picture_path(number: usize) -> String {
    format!("vtk/{}", picture_name(number))
}

/// Whether a file of that name is a picture of a series.
pub(crate) fn is_vtk_picture(name: &str) -> bool {
    let number = name.strip_prefix("picture-").and_then(|rest| rest.strip_suffix(".vtu"));
    number.and_then(|number| number.parse().ok()).is_some_and(|number| picture_name(number) == name)
}

/// What acted at a contact since the last picture.
#[derive(Debug, Clone, Copy)]
struct Acted {
    /// The block, and the point on it.
    block: usize,
    point: [f64; 2],
    /// Impulse on the block, N·s.
    impulse: [f64; 2],
}

/// Watches a run and writes its pictures as VTK files, each as it is taken: of thousands of blocks they
/// would fill the memory.
#[derive(Debug)]
pub struct VtkRecorder<'r> {
    results: &'r Results,
    scenery: Scenery,
    layout: Layout,
    schedule: Schedule,
    acted: BTreeMap<ContactId, Acted>,
    /// Time of the last picture, s.
    last: f64,
    /// Times of the pictures, s.
    times: Vec<f64>,
}

/// The kinds of cells, and their numbers in VTK.
const VERTEX: u8 = 1;
const LINE: u8 = 3;
const POLYGON: u8 = 7;

/// A picture as points and cells.
#[derive(Default)]
struct Picture {
    points: Vec<[f64; 2]>,
    forces: Vec<[f64; 2]>,
    /// Kind, number of the body, points.
    cells: Vec<Cell>,
}

impl<'r> VtkRecorder<'r> {
    /// A recorder for a run of `scene`, with pictures `every` so many seconds; none: 200 of them. They
    /// go to the subfolder `vtk` of `results`.
    #[must_use]
    pub fn new(results: &'r Results, scene: &Scene, layout: &Layout, every: Option<f64>) -> Self {
        let (end, steps) = (scene.time.end, scene.time.steps());
        let every = every.unwrap_or(end / PICTURES).max(end / MOST_PICTURES);
        Self {
            results,
            scenery: Scenery::new(scene, layout),
            layout: layout.clone(),
            schedule: Schedule::new(Some(every), steps, scene.time.step),
            acted: BTreeMap::new(),
            last: 0.0,
            times: Vec::new(),
        }
    }

    /// Writes the list of the pictures with their times, and removes pictures of an interrupted run that
    /// this one, which resumed it, didn't replace.
    ///
    /// # Errors
    /// If a file can't be written or removed.
    pub fn finish(&self) -> Result<(), ResultsError> {
        let left_over = |number: &usize| self.results.folder().join(picture_path(*number)).exists();
        for number in (self.times.len()..).take_while(left_over) {
            self.results.remove(&picture_path(number))?;
        }
        let mut series = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n".to_owned();
        for (number, t) in self.times.iter().enumerate() {
            let name = picture_name(number);
            let _ = writeln!(series, "<DataSet timestep=\"{t:?}\" part=\"0\" file=\"{name}\"/>");
        }
        series.push_str("</Collection>\n</VTKFile>\n");
        self.results.write(VTK_SERIES, series)
    }

    fn add(&mut self, contact: &Contact<2>) {
        let Some((block, _)) = self.scenery.bodies_of(contact.id.pair()) else { return };
        let point = contact.sides[0].point;
        let impulse = contact.frame.transpose() * contact.p;
        let none = Acted { block, point: [point[0], point[1]], impulse: [0.0; 2] };
        let acted = self.acted.entry(contact.id).or_insert(none);
        acted.point = none.point;
        (0..2).for_each(|k| acted.impulse[k] += impulse[k]);
    }

    fn take(&mut self, state: &State) -> Result<(), ResultsError> {
        let mut picture = Picture::default();
        for (number, (block, drawn)) in self.layout.blocks.iter().zip(&self.scenery.blocks).enumerate() {
            let mut pose = [0.0; BLOCK_FRAME];
            pose.copy_from_slice(&state.q[block.range.clone()]);
            for line in Outline::of(drawn, pose).lines() {
                picture.add(POLYGON, number, line.into_iter().map(|(x, y)| [x, y]));
            }
        }
        for (number, (place, drawn)) in self.layout.beams.iter().zip(&self.scenery.beams).enumerate() {
            let q = &state.q[place.range.clone()];
            // Supports that move carry the beam with them.
            let carried = place.support_displacement(&state.q);
            let last = (drawn.places.len().max(2) - 1) as f64;
            let axis = drawn.places.iter().enumerate().map(|(k, at)| {
                let x = drawn.span * k as f64 / last;
                let along = place.axial_displacement_at(q, x);
                [drawn.x + x + along + carried[0], drawn.y + at.deflection(q) + carried[1]]
            });
            let first = picture.points.len();
            picture.points.extend(axis);
            let body = self.layout.blocks.len() + number;
            picture.cells.extend((first + 1..picture.points.len()).map(|k| (LINE, body, vec![k - 1, k])));
        }
        picture.forces.resize(picture.points.len(), [0.0; 2]);
        let lasted = state.t - self.last;
        for acted in self.acted.values().filter(|_| lasted > 0.0) {
            let Some(place) = self.layout.blocks.get(acted.block) else { continue };
            let q = &state.q[place.range.clone()];
            let (sin, cos) = q[2].sin_cos();
            let [a, b] = acted.point;
            picture.add(VERTEX, acted.block, [[q[0] + cos * a - sin * b, q[1] + sin * a + cos * b]]);
            picture.forces.push(acted.impulse.map(|impulse| impulse / lasted));
        }
        self.acted.clear();
        self.last = state.t;
        let path = picture_path(self.times.len());
        self.times.push(state.t);
        self.results.write(&path, picture.to_xml())
    }
}

impl Picture {
    fn add(&mut self, kind: u8, body: usize, points: impl IntoIterator<Item = [f64; 2]>) {
        let first = self.points.len();
        self.points.extend(points);
        self.cells.push((kind, body, (first..self.points.len()).collect()));
    }

    fn to_xml(&self) -> String {
        let mut xml = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
             <UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
            self.points.len(),
            self.cells.len()
        );
        let vectors = |rows: &[[f64; 2]]| rows.iter().map(|[x, y]| format!("{x:?} {y:?} 0.0\n")).collect::<String>();
        let mut array = |open: &str, name: &str, kind: &str, components: usize, data: &str, close: &str| {
            let _ = write!(
                xml,
                "{open}<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">\n{data}</DataArray>\n{close}"
            );
        };
        array("<Points>\n", "Points", "Float64", 3, &vectors(&self.points), "</Points>\n");
        let lines =
            |text: &dyn Fn(&Cell) -> String| self.cells.iter().map(|cell| text(cell) + "\n").collect::<String>();
        let connectivity =
            lines(&|(_, _, points)| points.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "));
        array("<Cells>\n", "connectivity", "Int64", 1, &connectivity, "");
        let mut end = 0;
        let offsets: String = self
            .cells
            .iter()
            .map(|(_, _, points)| {
                end += points.len();
                format!("{end}\n")
            })
            .collect();
        array("", "offsets", "Int64", 1, &offsets, "");
        array("", "types", "UInt8", 1, &lines(&|(kind, ..)| kind.to_string()), "</Cells>\n");
        array("<PointData Vectors=\"force\">\n", "force", "Float64", 3, &vectors(&self.forces), "</PointData>\n");
        array(
            "<CellData Scalars=\"body\">\n",
            "body",
            "Int64",
            1,
            &lines(&|(_, body, _)| body.to_string()),
            "</CellData>\n",
        );
        xml.push_str("</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
        xml
    }
}

impl Observer<2> for VtkRecorder<'_> {
    fn start(&mut self, _: &Model<2>, state: &State) -> Result<(), ObserverError> {
        self.schedule.takes(state.step, state.t);
        self.last = state.t;
        Ok(self.take(state)?)
    }

    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        for contact in step.contacts() {
            self.add(contact);
        }
        if self.schedule.takes(state.step, state.t) {
            self.take(state)?;
        }
        Ok(ControlFlow::Continue(()))
    }
}
