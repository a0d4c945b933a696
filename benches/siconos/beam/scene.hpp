// What the scenes of the source paper (docs/theory.md §8) bring to Siconos' kernel: the beam's matrices, the block, and a corner of it over the
// beam's axis (theory.md §3, `deformed`). Included by `theirs.cpp` and `../../peers/siconos.cpp`, each one program.

#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <SiconosKernel.hpp>

namespace paper {

constexpr double kPi = 3.14159265358979323846;
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

inline void assemble(const BeamMesh& mesh, SimpleMatrix& M, SimpleMatrix& K) {
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

/// A rectangle of this mass at rest, X, Y of its centre and its angle given.
inline std::shared_ptr<LagrangianLinearTIDS> rectangle(double width, double height, double mass, double x, double y, double tilt) {
  auto M = std::make_shared<SimpleMatrix>(3, 3);
  M->zero();
  M->setValue(0, 0, mass);
  M->setValue(1, 1, mass);
  M->setValue(2, 2, mass * (width * width + height * height) / 12);
  auto q = std::make_shared<SiconosVector>(3), v = std::make_shared<SiconosVector>(3);
  v->zero();
  q->setValue(0, x);
  q->setValue(1, y);
  q->setValue(2, tilt);
  auto block = std::make_shared<LagrangianLinearTIDS>(q, v, M);
  auto weight = std::make_shared<SiconosVector>(3);
  weight->zero();
  weight->setValue(1, -mass * kGravity);
  block->setFExtPtr(weight);
  return block;
}

/// The block on its lower left corner, which is at (`corner`, 0), tilted by 5°; its weight is its only force.
inline std::shared_ptr<LagrangianLinearTIDS> tilted_block(double corner) {
  const double tilt = 5 * kPi / 180, x = -0.5 * kBlockWidth, y = -0.5 * kBlockHeight;
  const double mass = kDensity * kBlockWidth * kBlockHeight * kBlockDepth;
  return rectangle(kBlockWidth, kBlockHeight, mass, corner - (std::cos(tilt) * x - std::sin(tilt) * y),
                   -(std::sin(tilt) * x + std::cos(tilt) * y), tilt);
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

}  // namespace paper
