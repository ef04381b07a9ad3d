// Bullet's deformable bodies as a client of springproof: see README.md beside this file.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

using Json = nlohmann::json;

struct Array {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;

  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

Json header;
std::map<std::string, Array> arrays;

void read_scene() {
  std::string line;
  std::getline(std::cin, line);
  header = Json::parse(line);
  for (const Json& entry : header["arrays"]) {
    Array& array = arrays[entry["name"]];
    array.rows = entry["shape"][0], array.columns = entry["shape"][1];
    array.values.resize(array.rows * array.columns);
    std::cin.read(reinterpret_cast<char*>(array.values.data()), 8 * std::streamsize(array.values.size()));
  }
}

/// Standard output is the protocol's alone: what Bullet prints there goes to standard error.
std::ostream answer(std::cout.rdbuf());

void say(const Json& line, const std::vector<double>& values = {}) {
  answer << line.dump() << '\n';
  answer.write(reinterpret_cast<const char*>(values.data()), 8 * std::streamsize(values.size()));
  answer.flush();
}

/// A load's factor at a time: a sine, or linear between points; at a jump what comes after it.
double factor(const Json& history, double t) {
  if (history["frequency"] != 0) return std::sin(2 * M_PI * history["frequency"].get<double>() * t);
  const Json& points = history["points"];
  if (points.empty()) return 1;
  std::size_t next = 0;
  while (next < points.size() && points[next][0] <= t) ++next;
  if (next == 0) return points[0][1];
  if (next == points.size()) return points.back()[1];
  const double t0 = points[next - 1][0], f0 = points[next - 1][1], t1 = points[next][0], f1 = points[next][1];
  return f0 + (f1 - f0) * (t - t0) / (t1 - t0);
}

/// Gravity and loads: a force on each node, whatever its place.
class NodalForces : public btDeformableGravityForce {
 public:
  TVStack at; ///< N

  NodalForces() : btDeformableGravityForce(btVector3(0, 0, 0)) {}
  void addScaledForces(btScalar scale, TVStack& force) override {
    for (int i = 0; i < at.size(); ++i) force[i] += scale * at[i];
  }
  void addScaledExplicitForce(btScalar scale, TVStack& force) override { addScaledForces(scale, force); }

  void set(const std::vector<double>& masses, double t) {
    const auto share = [&](const Json& load) {
      return header["question"] == "motion" ? factor(load["history"], t) : 1;
    };
    at.resize(int(masses.size()));
    for (int i = 0; i < at.size(); ++i) at[i].setZero();
    for (const Json& load : header["loads"]) {
      const Array& forces = arrays[load["forces"]];
      for (std::size_t row = 0; row < forces.rows; ++row)
        at[int(forces.at(row, 0))] +=
            share(load) * btVector3(forces.at(row, 1), forces.at(row, 2), forces.at(row, 3));
    }
    for (const Json& gravity : header["gravity"]) {
      const Json& g = gravity["acceleration"];
      for (int i = 0; i < at.size(); ++i)
        at[i] += share(gravity) * masses[std::size_t(i)] * btVector3(g[0], g[1], g[2]);
    }
  }
};

int main(int argc, char** argv) {
  std::cout.rdbuf(std::cerr.rdbuf());
  std::map<std::string, std::string> options{
      {"--law", "corotational"}, {"--substeps", "1"}, {"--damping", ""}};
  for (int i = 1; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  const bool is_corotational = options["--law"] == "corotational";
  const int n_substeps = std::atoi(options["--substeps"].c_str());
  if (options.size() > 3 || argc % 2 == 0 || n_substeps < 1 ||
      !(is_corotational || options["--law"] == "neohooke")) {
    std::cerr << "--law corotational|neohooke, --substeps N, --damping S\n";
    return 2;
  }
  read_scene();
  const bool is_motion = header["question"] == "motion";
  const Array &nodes = arrays["nodes"], &materials = arrays["materials"], &supports = arrays["supports"],
              &motion = arrays["support_motion"];

  std::vector<int> n_held(nodes.rows);
  for (std::size_t row = 0; row < supports.rows; ++row) ++n_held[std::size_t(supports.at(row, 0))];
  std::vector<std::string> unsupported{"springs and their terms: it takes E and nu on tetrahedra"};
  const auto ignored = [&](bool is, const std::string& what) {
    if (is) unsupported.push_back(what);
  };
  int n_partly = 0;
  for (const int n : n_held) n_partly += n == 1 || n == 2;
  ignored(arrays.count("hexahedra"), "hexahedra: each is cut into 6 tetrahedra");
  ignored(n_partly > 0, "supports of single components (" + std::to_string(n_partly) + " nodes)");
  bool is_one_material = true;
  for (std::size_t i = 4; i < materials.values.size(); ++i)
    is_one_material &=
        materials.values[i] == materials.values[i - 4] || i % 4 == 2; // densities are in the masses
  ignored(!is_one_material, "all materials but the first");
  ignored(is_motion, "scheme " + header.value("/scheme/name"_json_pointer, ""));

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btDeformableBodySolver solver;
  btDeformableMultiBodyConstraintSolver constraints;
  constraints.setDeformableSolver(&solver);
  btDeformableMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration, &solver);
  world.setGravity(btVector3(0, 0, 0)); // NodalForces have it

  std::vector<btVector3> places;
  std::vector<double> masses = arrays["mass"].values, body_masses;
  bool has_masses = false;
  for (const double m : masses) has_masses |= m > 0;
  ignored(!has_masses, "no masses: every node has 1 g");
  for (std::size_t i = 0; i < nodes.rows; ++i) {
    places.emplace_back(nodes.at(i, 0), nodes.at(i, 1), nodes.at(i, 2));
    if (!has_masses) masses[i] = 1e-3;
    body_masses.push_back(n_held[i] == 3 ? 0 : masses[i]);
  }
  btSoftBody body(&world.getWorldInfo(), int(nodes.rows), places.data(), body_masses.data());
  const auto add = [&](const Array& cells, std::size_t c, const std::array<std::size_t, 4>& v) {
    body.appendTetra(int(cells.at(c, v[0])), int(cells.at(c, v[1])), int(cells.at(c, v[2])),
                     int(cells.at(c, v[3])));
  };
  for (std::size_t c = 0; c < arrays["tetrahedra"].rows; ++c) add(arrays["tetrahedra"], c, {0, 1, 2, 3});
  // Around the diagonal from vertex 0 to 7, vertex i + 2j + 4k.
  const std::array<std::size_t, 7> ring{1, 3, 2, 6, 4, 5, 1};
  for (std::size_t c = 0; c < arrays["hexahedra"].rows; ++c)
    for (std::size_t k = 0; k < 6; ++k) add(arrays["hexahedra"], c, {0, ring[k], ring[k + 1], 7});
  btSoftBodyHelpers::generateBoundaryFaces(&body);
  body.initializeDmInverse();
  body.m_tetraScratches.resize(body.m_tetras.size());
  body.m_tetraScratchesTn.resize(body.m_tetras.size());
  body.setActivationState(DISABLE_DEACTIVATION);
  body.m_cfg.collisions = 0;
  world.addSoftBody(&body, 0, 0);

  const double E = materials.at(0, 0), nu = materials.at(0, 1);
  const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  btDeformableLinearElasticityForce corotational(mu, lambda);
  btDeformableNeoHookeanForce neo_hookean(mu, lambda);
  if (!options["--damping"].empty()) {
    corotational.setDamping(corotational.m_damping_alpha, std::stod(options["--damping"]));
    neo_hookean.setDamping(std::stod(options["--damping"]));
  }
  if (is_motion) { // the case's own
    corotational.setDamping(materials.at(0, 3), header["stiffness_damping"]);
    neo_hookean.setDamping(header["stiffness_damping"]);
    ignored(!is_corotational && materials.at(0, 3) > 0, "mass_damping");
  }
  NodalForces forces;
  world.addForce(&body, &forces);
  if (is_corotational)
    world.addForce(&body, &corotational);
  else
    world.addForce(&body, &neo_hookean);

  say({{"protocol", 1},
       {"name", "Bullet"},
       {"version", std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100)},
       {"method", "tetrahedra, " + options["--law"] + ", explicit with implicit damping"},
       {"settings",
        {{"substeps", n_substeps},
         {"damping", is_corotational ? corotational.m_damping_beta : neo_hookean.m_mu_damp / mu},
         {"step", header["step"]}}},
       {"unsupported", unsupported}});

  double seconds = 0;
  int n_steps = 0;
  const auto positions = [&] {
    std::vector<double> all;
    for (int i = 0; i < body.m_nodes.size(); ++i)
      for (int c = 0; c < 3; ++c) all.push_back(body.m_nodes[i].m_x[c]);
    return all;
  };
  /// Supports that move have a velocity: in a motion that to the next frame, else that to the full one in a
  /// second.
  const auto step = [&](double dt, double t, std::size_t frame) {
    const auto start = std::chrono::steady_clock::now();
    forces.set(masses, t);
    for (std::size_t i = 0; motion.rows > 0 && i < supports.rows; ++i) {
      const std::size_t node = std::size_t(supports.at(i, 0)), c = std::size_t(supports.at(i, 1));
      if (n_held[node] != 3) continue;
      const double target =
          nodes.at(node, c) + (is_motion ? motion.at(frame, i) : std::min(t, 1.) * motion.at(0, i));
      body.m_nodes[int(node)].m_v[int(c)] = (target - body.m_nodes[int(node)].m_x[int(c)]) / dt;
    }
    for (int k = 0; k < n_substeps; ++k) world.stepSimulation(dt / n_substeps, 0);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++n_steps;
    for (const double x : positions())
      if (!std::isfinite(x)) {
        say({{"error", "a node is at no finite place after " + std::to_string(t) + " s"}});
        std::exit(0);
      }
  };
  const auto frame = [&](std::size_t number, double t, Json more, const std::vector<double>& values) {
    more.update({{"frame", number},
                 {"time", t},
                 {"seconds", seconds},
                 {"steps", n_steps},
                 {"has", "positions"},
                 {"nodes", nodes.rows}});
    say(more, values);
  };
  if (is_motion) {
    const std::vector<double> times = header["times"];
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (k > 0) step(times[k] - times[k - 1], times[k], k);
      frame(k, times[k], Json::object(), positions());
    }
  } else { // at rest, as clients/protocol.mjs has it
    const double dt = header["step"];
    const int last = int(std::lround(header["end"].get<double>() / dt)), half = last / 2;
    const int every = std::max(1, int(std::lround(0.5 / dt)));
    std::vector<double> before = positions(), sum(before.size());
    bool is_at_rest = false;
    int k = 0;
    while (k < last && !is_at_rest) {
      ++k;
      step(dt, k * dt, 0);
      const std::vector<double> now = positions();
      for (std::size_t i = 0; k > half && i < now.size(); ++i) sum[i] += now[i] / (last - half);
      if (k % every != 0) continue;
      double moved = 0, largest = 0;
      for (std::size_t i = 0; i < now.size(); ++i) {
        moved = std::max(moved, std::abs(now[i] - before[i]));
        largest = std::max(largest, std::abs(now[i] - nodes.values[i]));
      }
      is_at_rest = moved <= 1e-4 * largest;
      before = now;
    }
    if (is_at_rest)
      frame(0, k * dt, {{"at_rest", true}}, before);
    else
      frame(0, k * dt, {{"at_rest", false}, {"mean_from", half * dt}}, sum);
  }
  say({{"end", true}});
}
