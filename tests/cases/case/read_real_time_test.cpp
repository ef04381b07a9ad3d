#include "cases/case/readers.hpp"

#include "tests/support/case_text.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <utility>

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("steps in real time are read") {
  const std::string density = "poissons_ratio = 0.35\ndensity = 1000";
  const std::string still = replaced(good_case, "poissons_ratio = 0.35", density);
  CHECK_FALSE(read_text(still).msm.real_time);
  const auto real_time =
      read_text(replaced(still, "split = 0.8", "split = 0.8\nreal_time = { method = 'xpbd' }")).msm.real_time;
  REQUIRE(real_time);
  CHECK(real_time->method == StepMethod::xpbd);
  CHECK(real_time->iterations == 10);
  CHECK_FALSE(real_time->substeps);
  CHECK(real_time->step == 1. / 60);
  CHECK(real_time->end == 20);
  CHECK(real_time->damping == 2);
  const Case all = read_text(replaced(still, "split = 0.8",
                                      "split = 0.8\nreal_time = { method = 'implicit_euler', iterations = 3, "
                                      "substeps = 4, step = 0.01, end = 2, damping = 0 }"));
  CHECK(all.msm.real_time->iterations == 3);
  CHECK(all.msm.real_time->substeps == 4);
  CHECK(all.msm.real_time->step == 0.01);
  CHECK(all.msm.real_time->end == 2);
  CHECK(all.msm.real_time->damping == 0);
  const Case set =
      read_text(still, {"msm.real_time.method=projective_dynamics", "msm.real_time.iterations=50"});
  REQUIRE(set.msm.real_time);
  CHECK(set.msm.real_time->iterations == 50);
  CHECK_FALSE(set.msm.real_time->chebyshev);
  const Case accelerated =
      read_text(still, {"msm.real_time.method=projective_dynamics", "msm.real_time.chebyshev=0.95"});
  CHECK(accelerated.msm.real_time->chebyshev == 0.95);
}

TEST_CASE("steps of finite elements have their defaults, and elements that methods take") {
  const std::string still =
      replaced(good_case, "poissons_ratio = 0.35", "poissons_ratio = 0.35\ndensity = 1000");
  CHECK_FALSE(read_text(still).fem.real_time);
  const auto with = [&](const std::string& keys, const std::string& element = "") {
    return read_text(replaced(still, "element = 'q1_bbar'", element + "real_time = { " + keys + " }")).fem;
  };
  const auto corotational = with("method = 'corotational'");
  REQUIRE(corotational.real_time);
  CHECK(corotational.real_time->method == ElementMethod::corotational);
  CHECK(corotational.real_time->iterations == 10);
  CHECK_FALSE(corotational.real_time->substeps);
  CHECK(corotational.element == Element::q1_bbar);
  CHECK(corotational.mass == ElementMass::lumped);
  CHECK(with("method = 'corotational'", "element = 'q1'\n").element == Element::q1);
  CHECK(with("method = 'total_lagrangian_explicit', substeps = 9").element == Element::q1);
  CHECK(with("method = 'xpbd', iterations = 3, damping = 0").element == Element::p1);
}

TEST_CASE("steps of finite elements are refused where they have no meaning") {
  const std::string still =
      replaced(good_case, "poissons_ratio = 0.35", "poissons_ratio = 0.35\ndensity = 1000");
  const auto refused = [&](const std::string& text, const std::string& key, const std::string& allowed) {
    CAPTURE(text);
    CHECK_THROWS_WITH(read_text(text), Catch::Contains(key) && Catch::Contains(allowed));
  };
  const auto with = [&](const std::string& keys, const std::string& more = "") {
    return replaced(still, "element = 'q1_bbar'", more + "real_time = { " + keys + " }");
  };
  refused(with("method = 'implicit_euler'"), "fem.real_time.method", "corotational");
  refused(with("method = 'total_lagrangian_explicit', iterations = 3"), "fem.real_time.iterations",
          "explicit");
  refused(with("method = 'corotational'", "mass = 'consistent'\n"), "fem.real_time", "consistent");
  refused(with("method = 'corotational'", "element = 'q2'\n"), "fem.element", "q1_bbar");
  refused(with("method = 'total_lagrangian_explicit'", "element = 'q1_bbar'\n"), "fem.element", "q1");
  refused(with("method = 'xpbd'", "element = 'q1'\n"), "fem.element", "p1");
  refused(replaced(good_case, "element = 'q1_bbar'", "real_time = { method = 'corotational' }"),
          "fem.real_time", "material.density");
  refused(replaced(dynamic_case, "mass = 'lumped'", "real_time = { method = 'corotational' }"), "dynamics",
          "fem.real_time");
  refused(replaced(with("method = 'corotational'"),
                   "kind = 'tilt'\ntop = 'z+ x- y-'\nbottom = 'z- x- y-'\ntoward = 'x'",
                   "kind = 'strain_energy'"),
          "measure[0].kind", "fem.real_time");
  const std::string ogden = replaced(
      replaced(replaced(with("method = 'corotational'"), "'linear_elastic'", "'ogden'"),
               "youngs_modulus = 0.3\npoissons_ratio = 0.35", "mu = [0.1]\nalpha = [2]\nbulk_modulus = 5"),
      "formulation = 'log_strain'", "formulation = 'hyperelastic'");
  refused(ogden, "fem.real_time", "total_lagrangian_explicit");
}

TEST_CASE("steps in real time are refused where they have no meaning") {
  const auto with = [](const std::string& keys, const std::string& more = "") {
    return replaced(replaced(good_case, "poissons_ratio = 0.35", "poissons_ratio = 0.35\ndensity = 1000"),
                    "split = 0.8", "split = 0.8\n" + more + "real_time = { " + keys + " }");
  };
  const auto refused = [&](const std::string& text, const std::string& key, const std::string& allowed) {
    CAPTURE(text);
    CHECK_THROWS_WITH(read_text(text), Catch::Contains(key) && Catch::Contains(allowed));
  };
  refused(with("method = 'verlet'"), "msm.real_time.method", "vertex_block_descent");
  refused(with("iterations = 3"), "msm.real_time.method", "missing");
  refused(with("method = 'xpbd', iterations = 0"), "msm.real_time.iterations", "from 1");
  refused(with("method = 'xpbd', chebyshev = 0.9"), "msm.real_time.chebyshev", "projective_dynamics");
  refused(with("method = 'projective_dynamics', chebyshev = 1"), "msm.real_time.chebyshev", "below 1");
  refused(with("method = 'xpbd', steps = 3"), "steps", "msm.real_time");
  refused(with("method = 'symplectic_euler', iterations = 3"), "msm.real_time.iterations", "explicit");
  refused(with("method = 'xpbd', step = 1e-6, end = 1e5"), "msm.real_time.end", "1e7 steps");
  refused(with("method = 'xpbd'", "solver = 'fire'\n"), "msm.real_time", "solver");
  refused(with("method = 'xpbd'", "mass = 'consistent'\n"), "msm.real_time", "consistent");
  refused(replaced(good_case, "split = 0.8", "split = 0.8\nreal_time = { method = 'xpbd' }"), "msm.real_time",
          "material.density");
  for (const std::string method : {"xpbd", "projective_dynamics"})
    refused(replaced(replaced(with("method = '" + method + "'"), "split = 0.8\n", ""), "'moduli'",
                     "'biquadratic'"),
            "msm.real_time", "vertex_block_descent");
  const auto in_motion = [](const std::string& keys) {
    return replaced(dynamic_case, "mass = 'uniform'", "mass = 'uniform'\nreal_time = { " + keys + " }");
  };
  refused(in_motion("method = 'xpbd'"), "dynamics", "implicit_euler");
  refused(in_motion("method = 'xpbd', step = 0.1"), "msm.real_time.step", "[dynamics]");
}

TEST_CASE("a memory is refused beside steps in real time, which have none") {
  const std::string euler = replaced(replaced(dynamic_case, "'newmark'", "'implicit_euler'"),
                                     "mass_damping = 0.5\nstiffness_damping = 0.001",
                                     "prony = [{ g = 0.2, tau = 0.1 }]");
  CHECK_NOTHROW(read_text(euler));
  for (const auto& [table, method] : {std::pair("[msm]", "xpbd"), std::pair("[fem]", "corotational")}) {
    const std::string steps = std::string(table) + "\nreal_time = { method = '" + method + "' }";
    INFO(steps);
    CHECK_THROWS_WITH(read_text(replaced(euler, table, steps)),
                      Catch::Contains("real_time") && Catch::Contains("material.prony"));
  }
}
