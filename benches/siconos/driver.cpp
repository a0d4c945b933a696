// Runs one of Siconos' solvers on one FCLIB problem and judges the answer; or judges another program's impulses.
//
//   driver solve PROBLEM.hdf5 SOLVER TOLERANCE CAP RUNS BUDGET LIMIT   a line of JSON: end, judged residual, times
//   driver judge PROBLEM.hdf5 IMPULSES.csv                             the judged residual (impulses: a number a line)
//   driver describe PROBLEM.hdf5                                       dimension, contacts, and how W is given (see below)
//
// TOLERANCE is the solver's own, CAP its iteration cap (0: none), RUNS the most repetitions, BUDGET the CPU seconds after
// which it repeats no more, LIMIT the CPU seconds a single solve may take. Nothing here trusts the solver's own error.
// W is given dense where at least half of it is filled, else in Siconos' block storage; "SOLVER dense" as the name of a
// solver gives it dense in any case.
// Links with siconos_numerics and fclib (both in Debian); see README.md.

#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <vector>

extern "C" {
#include <fclib.h>
}
#include <siconos/numerics/SiconosNumerics.h>
#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/NumericsVerbose.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/SparseBlockMatrix.h>

namespace {

[[noreturn]] void give_up(const std::string& why) {
  fprintf(stderr, "driver: %s\n", why.c_str());
  exit(2);
}

// ---------------------------------------------------------------------------------------------------------- the problem

/// W by rows of entries, as read; what Siconos is given is made from it anew for every run.
struct Problem {
  int dimension = 0, contacts = 0, size = 0;
  std::vector<std::map<int, double>> rows;
  std::vector<double> q, mu;
  size_t filled = 0;
};

Problem read_problem(const char* path) {
  fclib_local* file = fclib_read_local(path);
  if (!file || !file->W) give_up(std::string("can't read ") + path);
  const fclib_matrix& w = *file->W;
  Problem problem;
  problem.dimension = file->spacedim;
  problem.size = w.m;
  problem.contacts = w.m / file->spacedim;
  problem.rows.resize(w.m);
  problem.q.assign(file->q, file->q + w.m);
  problem.mu.assign(file->mu, file->mu + problem.contacts);
  if (w.nz >= 0) {  // triplets, rows in `i` as CSparse has them (Siconos writes them so, whatever fclib.h says)
    for (int k = 0; k < w.nz; ++k) problem.rows[w.i[k]][w.p[k]] += w.x[k];
  } else {
    const int lines = w.nz == -1 ? w.n : w.m;
    for (int line = 0; line < lines; ++line)
      for (int k = w.p[line]; k < w.p[line + 1]; ++k) {
        const int row = w.nz == -1 ? w.i[k] : line, column = w.nz == -1 ? line : w.i[k];
        problem.rows[row][column] += w.x[k];
      }
  }
  for (const auto& row : problem.rows) problem.filled += row.size();
  return problem;
}

// --------------------------------------------------------------------------------------------------------------- the judge

/// The nearest point of {‖t‖ ≤ μ n}.
void project(double* v, int dimension, double mu) {
  double t = 0;
  for (int k = 1; k < dimension; ++k) t += v[k] * v[k];
  t = std::sqrt(t);
  if (t <= mu * v[0]) return;
  if (mu * t <= -v[0]) {
    std::fill(v, v + dimension, 0.0);
    return;
  }
  const double normal = (v[0] + mu * t) / (1 + mu * mu);
  v[0] = normal;
  for (int k = 1; k < dimension; ++k) v[k] *= mu * normal / t;
}

/// ‖r − Π(r − ρ û)‖ / max(‖r‖, ρ‖q‖, 1e-300), û = u + (μ‖u_T‖, 0), u = W r + q, ρ = 1/mean(diag W); NaN for NaN.
double judge(const Problem& problem, const double* r) {
  const int d = problem.dimension;
  double trace = 0;
  for (int i = 0; i < problem.size; ++i) {
    const auto entry = problem.rows[i].find(i);
    if (entry != problem.rows[i].end()) trace += entry->second;
  }
  const double rho = problem.size / trace;
  double map = 0, r_norm = 0, q_norm = 0;
  for (int c = 0; c < problem.contacts; ++c) {
    double u[3] = {0, 0, 0}, v[3], slip = 0;
    for (int k = 0; k < d; ++k) {
      const int i = c * d + k;
      u[k] = problem.q[i];
      for (const auto& [j, x] : problem.rows[i]) u[k] += x * r[j];
      if (k > 0) slip += u[k] * u[k];
      r_norm += r[i] * r[i];
      q_norm += problem.q[i] * problem.q[i];
    }
    u[0] += problem.mu[c] * std::sqrt(slip);
    for (int k = 0; k < d; ++k) v[k] = r[c * d + k] - rho * u[k];
    project(v, d, problem.mu[c]);
    for (int k = 0; k < d; ++k) map += (r[c * d + k] - v[k]) * (r[c * d + k] - v[k]);
  }
  return std::sqrt(map) / std::max({std::sqrt(r_norm), rho * std::sqrt(q_norm), 1e-300});
}

// --------------------------------------------------------------------------------------------------------- Siconos' problem

NumericsMatrix* dense(const Problem& problem) {
  auto* values = static_cast<double*>(calloc(size_t(problem.size) * problem.size, sizeof(double)));
  for (int i = 0; i < problem.size; ++i)
    for (const auto& [j, x] : problem.rows[i]) values[size_t(j) * problem.size + i] = x;  // by columns
  return NM_create_from_data(NM_DENSE, problem.size, problem.size, values);
}

NumericsMatrix* block_sparse(const Problem& problem) {
  const int d = problem.dimension;
  std::vector<std::map<int, double*>> blocks(problem.contacts);
  size_t count = 0;
  for (int c = 0; c < problem.contacts; ++c) {
    auto block = [&](int column) -> double* {
      double*& b = blocks[c][column];
      if (!b) {
        b = static_cast<double*>(calloc(size_t(d) * d, sizeof(double)));
        ++count;
      }
      return b;
    };
    block(c);  // the diagonal block is always there
    for (int k = 0; k < d; ++k)
      for (const auto& [j, x] : problem.rows[c * d + k]) block(j / d)[(j % d) * d + k] = x;  // by columns
  }
  SparseBlockStructuredMatrix* m = SBM_new();
  m->nbblocks = unsigned(count);
  m->blocknumber0 = m->blocknumber1 = unsigned(problem.contacts);
  m->blocksize0 = static_cast<unsigned*>(malloc(problem.contacts * sizeof(unsigned)));
  m->blocksize1 = static_cast<unsigned*>(malloc(problem.contacts * sizeof(unsigned)));
  m->block = static_cast<double**>(malloc(count * sizeof(double*)));
  m->filled1 = problem.contacts + 1;
  m->filled2 = count;
  m->index1_data = static_cast<size_t*>(malloc((problem.contacts + 1) * sizeof(size_t)));
  m->index2_data = static_cast<size_t*>(malloc(count * sizeof(size_t)));
  m->index1_data[0] = 0;
  size_t at = 0;
  for (int c = 0; c < problem.contacts; ++c) {
    m->blocksize0[c] = m->blocksize1[c] = unsigned((c + 1) * d);
    for (const auto& [column, values] : blocks[c]) {
      m->index2_data[at] = size_t(column);
      m->block[at++] = values;
    }
    m->index1_data[c + 1] = at;
  }
  return NM_create_from_data(NM_SPARSE_BLOCK, problem.size, problem.size, m);
}

FrictionContactProblem* for_siconos(const Problem& problem, bool as_dense) {
  auto copy = [](const std::vector<double>& v) {
    auto* to = static_cast<double*>(malloc(v.size() * sizeof(double)));
    memcpy(to, v.data(), v.size() * sizeof(double));
    return to;
  };
  NumericsMatrix* w = as_dense ? dense(problem) : block_sparse(problem);
  return frictionContactProblem_new_with_data(problem.dimension, problem.contacts, w, copy(problem.q), copy(problem.mu));
}

bool half_filled(const Problem& problem) { return 2 * problem.filled >= size_t(problem.size) * problem.size; }

int solver_id(const std::string& name, int dimension) {
  static const std::map<std::string, int> plane = {{"NSGS", SICONOS_FRICTION_2D_NSGS},
                                                   {"LEMKE", SICONOS_FRICTION_2D_LEMKE},
                                                   {"CPG", SICONOS_FRICTION_2D_CPG},
                                                   {"ENUM", SICONOS_FRICTION_2D_ENUM}};
  static const std::map<std::string, int> space = {{"NSGS", SICONOS_FRICTION_3D_NSGS},
                                                   {"NSN_AC", SICONOS_FRICTION_3D_NSN_AC},
                                                   {"ADMM", SICONOS_FRICTION_3D_ADMM},
                                                   {"PROX", SICONOS_FRICTION_3D_PROX},
                                                   {"VI_EG", SICONOS_FRICTION_3D_VI_EG}};
  const auto& names = dimension == 2 ? plane : space;
  const auto found = names.find(name);
  if (found == names.end()) give_up("no solver " + name + " in this dimension");
  return found->second;
}

// --------------------------------------------------------------------------------------------------------------- measuring

double now(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

void print_times(FILE* out, const char* name, const std::vector<double>& seconds) {
  fprintf(out, ", \"%s\": [", name);
  for (size_t k = 0; k < seconds.size(); ++k) fprintf(out, "%s%.6g", k ? ", " : "", seconds[k] * 1e3);
  fprintf(out, "]");
}

void print_head(FILE* out, const Problem& problem, const char* ended) {
  fprintf(out, "{\"dimension\": %d, \"contacts\": %d, \"ended\": \"%s\", ", problem.dimension, problem.contacts, ended);
}

void print_residual(FILE* out, double residual) {  // JSON has no NaN
  fprintf(out, std::isfinite(residual) ? ", \"residual\": %.9g" : ", \"residual\": null", residual);
}

// For the handler of the time limit, which runs in the middle of a solve.
const Problem* judged_problem = nullptr;
std::vector<double> reaction, velocity;
FILE* report = nullptr;
double limit_seconds = 0, limit_at = 0;

void set_alarm(double seconds) {
  itimerval t{};
  t.it_value.tv_sec = long(seconds);
  t.it_value.tv_usec = long((seconds - double(long(seconds))) * 1e6);
  setitimer(ITIMER_REAL, &t, nullptr);
}

// An alarm of elapsed time that looks at the CPU time: one of CPU time would make the CPU clock tick in milliseconds.
void out_of_time(int) {
  const double left = limit_at - now(CLOCK_PROCESS_CPUTIME_ID);
  if (left > 0) return set_alarm(std::max(left, 0.01));
  print_head(report, *judged_problem, "timeout");
  fprintf(report, "\"info\": null, \"iterations\": null");
  print_residual(report, judge(*judged_problem, reaction.data()));
  fprintf(report, ", \"cpu_ms\": [%.6g], \"wall_ms\": []}\n", limit_seconds * 1e3);
  fflush(report);
  _exit(0);
}

int solve(char** arguments) {
  const Problem problem = read_problem(arguments[0]);
  const std::string name = arguments[1], solver = name.substr(0, name.find(' '));
  const double tolerance = atof(arguments[2]), budget = atof(arguments[5]);
  const int cap = atoi(arguments[3]), runs = atoi(arguments[4]);
  limit_seconds = atof(arguments[6]);
  const int id = solver_id(solver, problem.dimension);

  // Siconos prints where it likes: its lines go nowhere, ours to where standard output was.
  report = fdopen(dup(1), "w");
  if (!report || !freopen("/dev/null", "w", stdout)) give_up("no standard output");
  numerics_set_verbose(0);

  // The pivoting solvers and CPG take a dense W only.
  const bool needs_dense = solver == "LEMKE" || solver == "CPG" || solver == "ENUM" || name == solver + " dense";
  const bool as_dense = needs_dense || half_filled(problem);

  judged_problem = &problem;
  signal(SIGALRM, out_of_time);
  std::vector<double> cpu, wall;
  int info = 0, iterations = 0;
  double spent = 0, residual = 0;
  for (int run = 0; run < runs && (run == 0 || spent < budget); ++run) {
    FrictionContactProblem* fresh = for_siconos(problem, as_dense);  // anew: conversions are cached in it
    SolverOptions* options = solver_options_create(id);
    options->dparam[SICONOS_DPARAM_TOL] = tolerance;
    if (cap > 0) options->iparam[SICONOS_IPARAM_MAX_ITER] = cap;
    reaction.assign(problem.size, 0.0);
    velocity.assign(problem.size, 0.0);

    limit_at = now(CLOCK_PROCESS_CPUTIME_ID) + limit_seconds;
    set_alarm(limit_seconds);
    const double wall_start = now(CLOCK_MONOTONIC), cpu_start = now(CLOCK_PROCESS_CPUTIME_ID);
    info = problem.dimension == 2 ? fc2d_driver(fresh, reaction.data(), velocity.data(), options)
                                  : fc3d_driver(fresh, reaction.data(), velocity.data(), options);
    const double cpu_end = now(CLOCK_PROCESS_CPUTIME_ID), wall_end = now(CLOCK_MONOTONIC);
    set_alarm(0);

    cpu.push_back(cpu_end - cpu_start);
    wall.push_back(wall_end - wall_start);
    spent += cpu.back();
    iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];
    const double judged = judge(problem, reaction.data());
    if (run == 0 || !(judged <= residual)) residual = judged;  // the worst of the runs, and a NaN is worst
    if (run + 1 == runs || spent >= budget) break;  // the last one isn't freed: the process ends
    frictionContactProblem_free(fresh);
    solver_options_delete(options);
  }
  print_head(report, problem, "returned");
  fprintf(report, "\"info\": %d, \"iterations\": %d", info, iterations);
  print_residual(report, residual);
  print_times(report, "cpu_ms", cpu);
  print_times(report, "wall_ms", wall);
  fprintf(report, "}\n");
  fflush(report);
  _exit(0);  // no exit handlers: some solvers corrupt the heap
}

int judge_file(char** arguments) {
  const Problem problem = read_problem(arguments[0]);
  std::ifstream file(arguments[1]);
  std::vector<double> r;
  for (double x; file >> x;) r.push_back(x);
  if (int(r.size()) != problem.size) give_up(std::string(arguments[1]) + ": not one number a component");
  printf("%.9g\n", judge(problem, r.data()));
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 9 && !strcmp(arguments[1], "solve")) return solve(arguments + 2);
  if (count == 4 && !strcmp(arguments[1], "judge")) return judge_file(arguments + 2);
  if (count == 3 && !strcmp(arguments[1], "describe")) {
    const Problem problem = read_problem(arguments[2]);
    printf("%d %d %s\n", problem.dimension, problem.contacts, half_filled(problem) ? "dense" : "blocks");
    return 0;
  }
  fprintf(stderr, "usage: the first lines of driver.cpp\n");
  return 2;
}
