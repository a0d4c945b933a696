// The scene of the source paper (docs/theory.md §8, undeformed start, no damping) in Siconos' own beam: dense matrices, time stepping by
// its kernel.
//
//   theirs rocking|free ELEMENTS STEPS WARM     a line of JSON: µs a step, and where the motion got to
//
// STEPS of 1e-4 s are timed as one, after WARM steps that are not. "rocking": the block over the beam; "free": the beam alone, swinging in its
// first mode. Matrices, relation, and what isn't Siconos' (its gap and Jacobian: theory.md §3, `deformed`) are in this file; the linear
// algebra, the scheme and the contact solver are Siconos'. Links with siconos_kernel and siconos_numerics (both in Debian); see README.md.

#include <time.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include <SiconosKernel.hpp>
#include <SolverOptions.h>
#include <Friction_cst.h>

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kStep = 1e-4, kTheta = 0.5;
constexpr double kSpan = 0.36, kWidth = 0.03, kThickness = 0.0015, kYoung = 69e9, kDensity = 2700.0;
constexpr double kBlockWidth = 0.03, kBlockHeight = 0.135, kBlockDepth = 0.03, kFriction = 0.5, kGravity = 9.81;

/// Cubic Hermite elements of equal length, pinned at both ends. The dofs are w, w' of one node after the other, without w of the
/// two ends.
struct BeamMesh {
  int elements;
  double length;

  explicit BeamMesh(int n) : elements(n), length(kSpan / n) {}
  unsigned dofs() const { return unsigned(2 * elements); }

  /// Where dof `local` of an element is in q; −1 for the w of a support.
  int place(int element, int local) const {
    const int dof = 2 * element + local;
    if (dof == 0 || dof == 2 * elements) return -1;
    return dof < 2 * elements ? dof - 1 : dof - 2;
  }

  std::array<double, 4> shape(double xi) const {
    const double s = xi * xi, c = s * xi;
    return {1 - 3 * s + 2 * c, length * (xi - 2 * s + c), 3 * s - 2 * c, length * (c - s)};
  }

  std::array<double, 4> slope(double xi) const {
    const double s = xi * xi;
    return {6 * (s - xi) / length, 1 - 4 * xi + 3 * s, 6 * (xi - s) / length, 3 * s - 2 * xi};
  }
};

void assemble(const BeamMesh& mesh, SimpleMatrix& M, SimpleMatrix& K) {
  const double l = mesh.length, area = kWidth * kThickness;
  const double ei = kYoung * kWidth * std::pow(kThickness, 3) / 12, mass = kDensity * area;
  const double k = ei / (l * l * l), m = mass * l / 420;
  const double Ke[4][4] = {{12, 6 * l, -12, 6 * l},
                           {6 * l, 4 * l * l, -6 * l, 2 * l * l},
                           {-12, -6 * l, 12, -6 * l},
                           {6 * l, 2 * l * l, -6 * l, 4 * l * l}};
  const double Me[4][4] = {{156, 22 * l, 54, -13 * l},
                           {22 * l, 4 * l * l, 13 * l, -3 * l * l},
                           {54, 13 * l, 156, -22 * l},
                           {-13 * l, -3 * l * l, -22 * l, 4 * l * l}};
  M.zero();
  K.zero();
  for (int e = 0; e < mesh.elements; ++e)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const int a = mesh.place(e, i), b = mesh.place(e, j);
        if (a < 0 || b < 0) continue;
        M.setValue(a, b, M.getValue(a, b) + m * Me[i][j]);
        K.setValue(a, b, K.getValue(a, b) + k * Ke[i][j]);
      }
}

/// A corner of the block over the beam's axis: y = (gap, ·), the rows of the Jacobian are n and t of theory.md §3. q = (block, beam).
class CornerOverBeam : public LagrangianScleronomousR {
 public:
  CornerOverBeam(const BeamMesh& mesh, double x, double y) : mesh_(mesh), x_(x), y_(y) {
    _jachq = std::make_shared<SimpleMatrix>(2, 3 + mesh.dofs());
    _jachq->zero();
  }

  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) override {
    const Foot foot = find(q);
    y.setValue(0, (foot.height - foot.w) / std::sqrt(1 + foot.slope * foot.slope));
    y.setValue(1, 0.0);
  }

  void computeJachq(const BlockVector& q, BlockVector&) override {
    const Foot foot = find(q);
    const double norm = 1 / std::sqrt(1 + foot.slope * foot.slope);
    const double n[2] = {-foot.slope * norm, norm}, t[2] = {norm, foot.slope * norm};
    const double* frame[2] = {n, t};
    const auto shape = mesh_.shape(foot.xi);
    // Only what the last call wrote is taken back, not the whole row.
    for (const int column : written_)
      for (unsigned row = 0; row < 2; ++row) _jachq->setValue(row, unsigned(column), 0.0);
    written_.clear();
    for (unsigned row = 0; row < 2; ++row) {
      const double* f = frame[row];
      _jachq->setValue(row, 0, f[0]);
      _jachq->setValue(row, 1, f[1]);
      _jachq->setValue(row, 2, f[1] * foot.arm_x - f[0] * foot.arm_y);
    }
    for (int i = 0; i < 4; ++i) {
      const int at = mesh_.place(foot.element, i);
      if (at < 0) continue;
      for (unsigned row = 0; row < 2; ++row) _jachq->setValue(row, unsigned(3 + at), -frame[row][1] * shape[i]);
      written_.push_back(3 + at);
    }
  }

 private:
  struct Foot {
    int element;
    double xi, arm_x, arm_y, height, w, slope;
  };

  Foot find(const BlockVector& q) const {
    const SiconosVector &block = *q.vector(0), &beam = *q.vector(1);
    const double c = std::cos(block(2)), s = std::sin(block(2));
    Foot foot{};
    foot.arm_x = c * x_ - s * y_;
    foot.arm_y = s * x_ + c * y_;
    foot.height = block(1) + foot.arm_y;
    const double along = (block(0) + foot.arm_x) / mesh_.length;
    foot.element = std::min(std::max(int(along), 0), mesh_.elements - 1);
    foot.xi = along - foot.element;
    const auto shape = mesh_.shape(foot.xi), slope = mesh_.slope(foot.xi);
    for (int i = 0; i < 4; ++i) {
      const int at = mesh_.place(foot.element, i);
      if (at < 0) continue;
      foot.w += shape[i] * beam(unsigned(at));
      foot.slope += slope[i] * beam(unsigned(at));
    }
    return foot;
  }

  const BeamMesh mesh_;
  const double x_, y_;
  std::vector<int> written_;
};

double now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    fprintf(stderr, "usage: the first lines of theirs.cpp\n");
    return 2;
  }
  const bool rocking = !strcmp(arguments[1], "rocking");
  const BeamMesh mesh(atoi(arguments[2]));
  const int steps = atoi(arguments[3]), warm = atoi(arguments[4]);
  const unsigned n = mesh.dofs();

  auto M = std::make_shared<SimpleMatrix>(n, n), K = std::make_shared<SimpleMatrix>(n, n);
  assemble(mesh, *M, *K);
  auto q0 = std::make_shared<SiconosVector>(n), v0 = std::make_shared<SiconosVector>(n);
  q0->zero();
  v0->zero();
  if (!rocking)  // the first mode, 1 mm at midspan
    for (int node = 0; node <= mesh.elements; ++node) {
      const double x = kPi * node / mesh.elements;
      const double values[2] = {1e-3 * std::sin(x), 1e-3 * kPi / kSpan * std::cos(x)};
      const int element = std::min(node, mesh.elements - 1), local = node < mesh.elements ? 0 : 2;
      for (int i = 0; i < 2; ++i)
        if (mesh.place(element, local + i) >= 0) q0->setValue(unsigned(mesh.place(element, local + i)), values[i]);
    }
  auto beam = std::make_shared<LagrangianLinearTIDS>(q0, v0, M);
  beam->setKPtr(K);

  const double end = (steps + warm + 10) * kStep;
  auto system = std::make_shared<NonSmoothDynamicalSystem>(0.0, end);
  auto discretisation = std::make_shared<TimeDiscretisation>(0.0, kStep);
  auto scheme = std::make_shared<MoreauJeanOSI>(kTheta);
  std::shared_ptr<LagrangianLinearTIDS> block;
  if (rocking) {
    const double tilt = 5 * kPi / 180, x = -0.5 * kBlockWidth, y = -0.5 * kBlockHeight;
    const double mass = kDensity * kBlockWidth * kBlockHeight * kBlockDepth;
    auto Mb = std::make_shared<SimpleMatrix>(3, 3);
    Mb->zero();
    Mb->setValue(0, 0, mass);
    Mb->setValue(1, 1, mass);
    Mb->setValue(2, 2, mass * (kBlockWidth * kBlockWidth + kBlockHeight * kBlockHeight) / 12);
    auto qb = std::make_shared<SiconosVector>(3), vb = std::make_shared<SiconosVector>(3);
    vb->zero();
    // Its lower left corner at x = 0.165 on the straight axis.
    qb->setValue(0, 0.165 - (std::cos(tilt) * x - std::sin(tilt) * y));
    qb->setValue(1, -(std::sin(tilt) * x + std::cos(tilt) * y));
    qb->setValue(2, tilt);
    block = std::make_shared<LagrangianLinearTIDS>(qb, vb, Mb);
    auto weight = std::make_shared<SiconosVector>(3);
    weight->zero();
    weight->setValue(1, -mass * kGravity);
    block->setFExtPtr(weight);
    system->insertDynamicalSystem(block);
    system->insertDynamicalSystem(beam);
    auto law = std::make_shared<NewtonImpactFrictionNSL>(0.0, 0.0, kFriction, 2);
    for (const double side : {-1.0, 1.0}) {
      auto relation = std::make_shared<CornerOverBeam>(mesh, side * 0.5 * kBlockWidth, -0.5 * kBlockHeight);
      system->link(std::make_shared<Interaction>(law, relation), block, beam);
    }
  } else {
    system->insertDynamicalSystem(beam);
  }
  auto contact = std::make_shared<FrictionContact>(2, SICONOS_FRICTION_2D_NSGS);
  contact->numericsSolverOptions()->dparam[SICONOS_DPARAM_TOL] = 1e-10;
  contact->numericsSolverOptions()->iparam[SICONOS_IPARAM_MAX_ITER] = 1000;
  auto simulation = std::make_shared<TimeStepping>(system, discretisation, scheme, contact);
  // The Jacobian of the predicted position for the whole step, one solve: the motion is that of the default, which looks for a fixed
  // point, in two thirds of its time.
  simulation->setNewtonOptions(SICONOS_TS_LINEAR);

  auto run = [&](int times) {
    for (int k = 0; k < times; ++k) {
      simulation->computeOneStep();
      simulation->nextStep();
    }
  };
  run(warm);
  const double start = now();
  run(steps);
  const double spent = now() - start;

  // w at midspan, by the mesh's shape functions.
  double middle = 0;
  const double along = 0.5 * mesh.elements;
  const int element = int(along);
  const auto shape = mesh.shape(along - element);
  for (int i = 0; i < 4; ++i)
    if (mesh.place(element, i) >= 0) middle += shape[i] * (*beam->q())(unsigned(mesh.place(element, i)));
  printf("{\"us\": %.6g, \"time\": %.6g, \"phi\": %.12g, \"w\": %.12g}\n", 1e6 * spent / steps, (steps + warm) * kStep,
         rocking ? (*block->q())(2) * 180 / kPi : 0.0, middle);
  return 0;
}
