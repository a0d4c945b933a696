// The scene of the source paper (docs/theory.md §8, undeformed start, no damping) in Siconos' own beam: dense matrices, time stepping by
// its kernel.
//
//   theirs rocking|free ELEMENTS STEPS WARM     a line of JSON: µs a step, and where the motion got to
//
// STEPS of 1e-4 s are timed as one, after WARM steps that are not. "rocking": the block over the beam; "free": the beam alone, swinging in its
// first mode. Matrices, relation, and what isn't Siconos' (its gap and Jacobian: theory.md §3, `deformed`) are in scene.hpp; the linear
// algebra, the scheme and the contact solver are Siconos'. Links with siconos_kernel and siconos_numerics (both in Debian); see README.md.

#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <Friction_cst.h>
#include <SolverOptions.h>

#include "scene.hpp"

namespace {

using namespace paper;

constexpr double kStep = 1e-4, kTheta = 0.5;

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
    block = tilted_block(0.165);
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
