// The scenes of `compare.py` in Siconos' kernel: jobs on standard input, an answer each (the protocol: README.md).
//
// The beam's matrices, the gap and the Jacobian of a corner over it are those of ../siconos/beam/scene.hpp; the linear algebra, the scheme and the
// contact solver are Siconos'. Links with siconos_kernel and siconos_numerics (both in Debian).
//
//   setting           is
//   theta             of the Moreau–Jean scheme
//   solver            NSGS, LEMKE, CPG or ENUM
//   tolerance         of the contact solver
//   threshold         gap below which a contact is active, m
//   gamma             the part of the step over which the gap is predicted; without it Siconos' own rule, half
//   projection        1: the combined projection scheme, which takes the penetration away
//   modes             the beam in so many of its lowest modes in place of its elements
//   sparse            1: the beam's matrices in Siconos' sparse storage
//   top               of a stack: how many times heavier its top box is
//   newton            1: a search for a fixed point in place of one solve a step

#include <time.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Friction_cst.h>
#include <MoreauJeanCombinedProjectionOSI.hpp>
#include <MLCPProjectOnConstraints.hpp>
#include <TimeSteppingCombinedProjection.hpp>
#include <SolverOptions.h>
#include <NonSmoothDrivers.h>

#include "../siconos/beam/scene.hpp"

namespace {

using namespace paper;

/// Repetitions end here, however short a run is.
constexpr size_t kMost = 51;

/// A corner of the block over the ground y = 0.
class CornerOverGround : public LagrangianScleronomousR {
 public:
  CornerOverGround(double x, double y) : x_(x), y_(y) {
    _jachq = std::make_shared<SimpleMatrix>(2, 3);
    _jachq->zero();
    _jachq->setValue(0, 1, 1.0);
    _jachq->setValue(1, 0, 1.0);
  }

  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) override {
    const SiconosVector& block = *q.vector(0);
    y.setValue(0, block(1) + std::sin(block(2)) * x_ + std::cos(block(2)) * y_);
    y.setValue(1, 0.0);
  }

  void computeJachq(const BlockVector& q, BlockVector&) override {
    const double phi = (*q.vector(0))(2), c = std::cos(phi), s = std::sin(phi);
    _jachq->setValue(0, 2, c * x_ - s * y_);
    _jachq->setValue(1, 2, -(s * x_ + c * y_));
  }

 private:
  const double x_, y_;
};

/// A corner of the block over the beam in its lowest modes, sines: w(x) = Σ q_k sin(kπx/L). The gap and the rows are those of CornerOverBeam.
class CornerOverSines : public LagrangianScleronomousR {
 public:
  CornerOverSines(unsigned modes, double x, double y) : modes_(modes), x_(x), y_(y) {
    _jachq = std::make_shared<SimpleMatrix>(2, 3 + modes);
    _jachq->zero();
  }

  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) override {
    const auto [arm_x, arm_y] = arm(q);
    const auto [w, slope] = surface(q, (*q.vector(0))(0) + arm_x);
    y.setValue(0, ((*q.vector(0))(1) + arm_y - w) / std::sqrt(1 + slope * slope));
    y.setValue(1, 0.0);
  }

  void computeJachq(const BlockVector& q, BlockVector&) override {
    const auto [arm_x, arm_y] = arm(q);
    const double x = (*q.vector(0))(0) + arm_x, slope = surface(q, x).second, norm = 1 / std::sqrt(1 + slope * slope);
    const double frame[2][2] = {{-slope * norm, norm}, {norm, slope * norm}};
    for (unsigned row = 0; row < 2; ++row) {
      const double* f = frame[row];
      _jachq->setValue(row, 0, f[0]);
      _jachq->setValue(row, 1, f[1]);
      _jachq->setValue(row, 2, f[1] * arm_x - f[0] * arm_y);
      for (unsigned k = 0; k < modes_; ++k) _jachq->setValue(row, 3 + k, -f[1] * std::sin((k + 1) * kPi * x / kSpan));
    }
  }

 private:
  std::pair<double, double> arm(const BlockVector& q) const {
    const double phi = (*q.vector(0))(2), c = std::cos(phi), s = std::sin(phi);
    return {c * x_ - s * y_, s * x_ + c * y_};
  }

  /// w and w' at x.
  std::pair<double, double> surface(const BlockVector& q, double x) const {
    double w = 0, slope = 0;
    for (unsigned k = 0; k < modes_; ++k) {
      const double number = (k + 1) * kPi / kSpan, amplitude = (*q.vector(1))(k);
      w += amplitude * std::sin(number * x);
      slope += amplitude * number * std::cos(number * x);
    }
    return {w, slope};
  }

  const unsigned modes_;
  const double x_, y_;
};

/// The beam in its lowest modes.
std::shared_ptr<LagrangianLinearTIDS> sines(unsigned modes) {
  const auto M = std::make_shared<SimpleMatrix>(modes, modes), K = std::make_shared<SimpleMatrix>(modes, modes);
  M->zero();
  K->zero();
  const double ei = kYoung * kWidth * std::pow(kThickness, 3) / 12;
  for (unsigned k = 0; k < modes; ++k) {
    M->setValue(k, k, 0.5 * kSpan * kDensity * kWidth * kThickness);
    K->setValue(k, k, 0.5 * kSpan * ei * std::pow((k + 1) * kPi / kSpan, 4));
  }
  const auto q = std::make_shared<SiconosVector>(modes), v = std::make_shared<SiconosVector>(modes);
  q->zero();
  v->zero();
  const auto beam = std::make_shared<LagrangianLinearTIDS>(q, v, M);
  beam->setKPtr(K);
  return beam;
}

/// The beam of finite elements.
std::shared_ptr<LagrangianLinearTIDS> elements(const BeamMesh& mesh, Siconos::UBLAS_TYPE storage) {
  const unsigned n = mesh.dofs();
  const auto M = std::make_shared<SimpleMatrix>(n, n, storage, 8 * n);
  const auto K = std::make_shared<SimpleMatrix>(n, n, storage, 8 * n);
  assemble(mesh, *M, *K);
  const auto q = std::make_shared<SiconosVector>(n), v = std::make_shared<SiconosVector>(n);
  q->zero();
  v->zero();
  const auto beam = std::make_shared<LagrangianLinearTIDS>(q, v, M);
  beam->setKPtr(K);
  return beam;
}

/// Boxes of a stack.
constexpr double kBox = 0.1, kBoxDensity = 700;

/// A lower corner of a box over the upper side of the one below it: q = (upper, lower).
class CornerOverBox : public LagrangianScleronomousR {
 public:
  explicit CornerOverBox(double x) : x_(x) {
    _jachq = std::make_shared<SimpleMatrix>(2, 6);
    _jachq->zero();
  }

  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) override {
    const auto [dx, dy] = from_lower(q);
    const double phi = (*q.vector(1))(2);
    y.setValue(0, -std::sin(phi) * dx + std::cos(phi) * dy - 0.5 * kBox);
    y.setValue(1, 0.0);
  }

  void computeJachq(const BlockVector& q, BlockVector&) override {
    const auto [arm_x, arm_y] = arm(q);
    const auto [dx, dy] = from_lower(q);
    const double phi = (*q.vector(1))(2);
    const double frame[2][2] = {{-std::sin(phi), std::cos(phi)}, {std::cos(phi), std::sin(phi)}};
    for (unsigned row = 0; row < 2; ++row) {
      const double* f = frame[row];
      const double values[6] = {f[0], f[1], f[1] * arm_x - f[0] * arm_y, -f[0], -f[1], -(f[1] * dx - f[0] * dy)};
      for (unsigned k = 0; k < 6; ++k) _jachq->setValue(row, k, values[k]);
    }
  }

 private:
  std::pair<double, double> arm(const BlockVector& q) const {
    const double phi = (*q.vector(0))(2), c = std::cos(phi), s = std::sin(phi), y = -0.5 * kBox;
    return {c * x_ - s * y, s * x_ + c * y};
  }

  std::pair<double, double> from_lower(const BlockVector& q) const {
    const auto [arm_x, arm_y] = arm(q);
    const SiconosVector &upper = *q.vector(0), &lower = *q.vector(1);
    return {upper(0) + arm_x - lower(0), upper(1) + arm_y - lower(1)};
  }

  const double x_;
};

struct Job {
  std::string scene, file;
  int elements = 0, steps = 0;
  double step = 0, budget = 0;
  std::map<std::string, std::string> settings;

  explicit Job(const std::string& line) {
    std::istringstream words(line);
    if (!(words >> scene >> elements >> step >> steps >> budget >> file))
      throw std::runtime_error("a job is: SCENE ELEMENTS STEP STEPS BUDGET FILE KEY=VALUE...");
    for (std::string word; words >> word;) {
      const auto at = word.find('=');
      if (at == std::string::npos) throw std::runtime_error("no KEY=VALUE: " + word);
      settings[word.substr(0, at)] = word.substr(at + 1);
    }
  }

  double number(const char* key, double otherwise) const {
    const auto found = settings.find(key);
    return found == settings.end() ? otherwise : std::stod(found->second);
  }

  int solver() const {
    const auto found = settings.find("solver");
    const std::string name = found == settings.end() ? "NSGS" : found->second;
    if (name == "NSGS") return SICONOS_FRICTION_2D_NSGS;
    if (name == "LEMKE") return SICONOS_FRICTION_2D_LEMKE;
    if (name == "CPG") return SICONOS_FRICTION_2D_CPG;
    if (name == "ENUM") return SICONOS_FRICTION_2D_ENUM;
    throw std::runtime_error("no solver " + name);
  }
};

/// A scene from its start, ready to step.
struct Run {
  std::shared_ptr<LagrangianLinearTIDS> block;
  std::shared_ptr<TimeStepping> simulation;

  explicit Run(const Job& job) {
    const auto system = std::make_shared<NonSmoothDynamicalSystem>(0.0, (job.steps + 10) * job.step);
    const auto law = std::make_shared<NewtonImpactFrictionNSL>(0.0, 0.0, kFriction, 2);
    const double below = -0.5 * kBlockHeight;
    if (job.scene == "ground") {
      block = tilted_block(-0.5 * kBlockWidth);
      system->insertDynamicalSystem(block);
      for (const double side : {-1.0, 1.0}) {
        const auto relation = std::make_shared<CornerOverGround>(side * 0.5 * kBlockWidth, below);
        system->link(std::make_shared<Interaction>(law, relation), block);
      }
    } else if (job.scene == "beam") {
      const BeamMesh mesh(job.elements);
      const auto modes = unsigned(job.number("modes", 0));
      const auto storage = job.number("sparse", 0) != 0 ? Siconos::SPARSE : Siconos::DENSE;
      const auto beam = modes ? sines(modes) : elements(mesh, storage);
      block = tilted_block(0.165);
      system->insertDynamicalSystem(block);
      system->insertDynamicalSystem(beam);
      for (const double side : {-1.0, 1.0}) {
        const double across = side * 0.5 * kBlockWidth;
        std::shared_ptr<LagrangianScleronomousR> relation;
        if (modes)
          relation = std::make_shared<CornerOverSines>(modes, across, below);
        else
          relation = std::make_shared<CornerOverBeam>(mesh, across, below);
        system->link(std::make_shared<Interaction>(law, relation), block, beam);
      }
    } else if (job.scene == "stack") {
      std::shared_ptr<LagrangianLinearTIDS> below_it;
      for (int k = 0; k < job.elements; ++k) {
        const double heavier = k + 1 == job.elements ? job.number("top", 1) : 1;
        block = rectangle(kBox, kBox, heavier * kBoxDensity * kBox * kBox * kBox, 0, (k + 0.5) * kBox, 0);
        system->insertDynamicalSystem(block);
        for (const double x : {-0.5 * kBox, 0.5 * kBox}) {
          if (k == 0)
            system->link(std::make_shared<Interaction>(law, std::make_shared<CornerOverGround>(x, -0.5 * kBox)), block);
          else
            system->link(std::make_shared<Interaction>(law, std::make_shared<CornerOverBox>(x)), block, below_it);
        }
        below_it = block;
      }
    } else {
      throw std::runtime_error("no scene " + job.scene + "; there are ground, beam and stack");
    }

    const auto times = std::make_shared<TimeDiscretisation>(0.0, job.step);
    const auto contact = std::make_shared<FrictionContact>(2, job.solver());
    contact->numericsSolverOptions()->dparam[SICONOS_DPARAM_TOL] = job.number("tolerance", 1e-10);
    contact->numericsSolverOptions()->iparam[SICONOS_IPARAM_MAX_ITER] = 1000;
    const double theta = job.number("theta", 0.5);
    std::shared_ptr<MoreauJeanOSI> scheme;
    if (job.number("projection", 0) != 0) {
      const auto projecting = std::make_shared<MoreauJeanCombinedProjectionOSI>(theta);
      scheme = projecting;
      simulation = std::make_shared<TimeSteppingCombinedProjection>(system, times, projecting, contact,
                                                                    std::make_shared<MLCPProjectOnConstraints>());
    } else {
      scheme = std::make_shared<MoreauJeanOSI>(theta);
      simulation = std::make_shared<TimeStepping>(system, times, scheme, contact);
    }
    if (job.settings.count("gamma")) scheme->setGamma(job.number("gamma", 1));
    scheme->setConstraintActivationThreshold(job.number("threshold", 0));
    // The Jacobian of the predicted position for the whole step, one solve.
    simulation->setNewtonOptions(job.number("newton", 0) != 0 ? SICONOS_TS_NONLINEAR : SICONOS_TS_LINEAR);
  }
};

double cpu() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::vector<double> measure(const Job& job) {
  std::vector<double> times, track;
  double spent = 0;
  while (times.empty() || (spent < job.budget && times.size() < kMost)) {
    const Run run(job);
    track.clear();
    track.reserve(3 * size_t(job.steps + 1));
    const SiconosVector& q = *run.block->q();
    const auto note = [&] { track.insert(track.end(), {q(0), q(1), q(2)}); };
    note();
    const double begin = cpu();
    for (int k = 0; k < job.steps; ++k) {
      run.simulation->computeOneStep();
      note();
      run.simulation->nextStep();
    }
    times.push_back(cpu() - begin);
    spent += times.back();
  }
  std::ofstream(job.file, std::ios::binary).write(reinterpret_cast<const char*>(track.data()), std::streamsize(8 * track.size()));
  return times;
}

}  // namespace

int main() {
  // Siconos tells of what it does on standard output, which here is for answers: those go to a copy of it, the rest to standard error.
  FILE* answers = fdopen(dup(1), "w");
  dup2(2, 1);
  for (std::string line; std::getline(std::cin, line);) {
    try {
      const auto times = measure(Job(line));
      fprintf(answers, "{\"cpu_s\": [");
      for (size_t k = 0; k < times.size(); ++k) fprintf(answers, "%s%.9g", k ? ", " : "", times[k]);
      fprintf(answers, "]}\n");
    } catch (const std::exception& error) {
      std::string said;
      for (const char c : std::string(error.what())) said += c == '"' || c == '\\' || c < ' ' ? ' ' : c;
      fprintf(answers, "{\"error\": \"%s\"}\n", said.c_str());
    }
    fflush(answers);
  }
}
