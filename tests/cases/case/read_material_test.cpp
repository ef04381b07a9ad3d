#include "cases/case/read_case.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("materials of a box and of a layer are read") {
  const Case c = read_text(replaced(
      good_case, "[[fixed]]",
      "[[region_material]]\nbox = [[0, 1, 2], [3, 4, 5]]\nmodel = 'linear_elastic'\nyoungs_modulus = 7\n"
      "poissons_ratio = 0.4\n[[region_material]]\naxis = 'y'\nto = 2\nmodel = 'linear_elastic'\n"
      "youngs_modulus = 8\npoissons_ratio = 0.4\n[[fixed]]"));
  REQUIRE(c.region_materials.size() == 2);
  CHECK(c.region_materials[0].lower == Eigen::Vector3d(0, 1, 2));
  CHECK(c.region_materials[0].upper == Eigen::Vector3d(3, 4, 5));
  CHECK(std::get<LinearElastic>(c.region_materials[0].material).youngs_modulus == 7);
  CHECK(c.region_materials[1].upper.y() == 2);
  CHECK(std::isinf(c.region_materials[1].lower.y()));
  CHECK(std::isinf(c.region_materials[1].upper.x()));
}

TEST_CASE("every material must suit the element and the springs' design") {
  const std::string other =
      "[[region_material]]\naxis = 'z'\nfrom = 5\nmodel = 'linear_elastic'\nyoungs_modulus = 1\n"
      "poissons_ratio = -0.1\n[[fixed]]";
  const std::string text = replaced(good_case, "[[fixed]]", other);
  CHECK_NOTHROW(read_text(text));
  const auto with = [&](const std::string& design) {
    return replaced(text, "design = 'moduli'\npoissons_ratio = 0.3\nsplit = 0.8\n", design);
  };
  CHECK_THROWS_WITH(read_text(with("design = 'hybrid'\n")),
                    Catch::Contains("region_material[0]") && Catch::Contains("0 and more"));
  CHECK_THROWS_WITH(read_text(with("design = 'given'\nstiffness = [1, 1, 1]\n")),
                    Catch::Contains("region_material[0]") && Catch::Contains("given"));
}

TEST_CASE("a mistake in [material] is refused where it is made") {
  const std::string material = "model = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n";
  check_mistakes({
      {"model = 'linear_elastic'",
       "model = 'linear_elastik'",
       9,
       "material.model",
       {"\"linear_elastic\" | \"ogden\"", "did you mean \"linear_elastic\"?"}},
      {"youngs_modulus = 0.3",
       "youngs_modulus = 0",
       10,
       "material.youngs_modulus",
       {"is 0", "above 0 (MPa)"}},
      {"youngs_modulus = 0.3",
       "youngs_modulus = inf",
       10,
       "material.youngs_modulus",
       {"is inf", "above 0 (MPa)"}},
      {"youngs_modulus = 0.3",
       "youngs_modulus = 'soft'",
       10,
       "material.youngs_modulus",
       {"is \"soft\"", "a number"}},
      {"youngs_modulus = 0.3",
       "young_modulus = 0.3",
       10,
       "material.young_modulus",
       {"did you mean \"youngs_modulus\"?"}},
      {"poissons_ratio = 0.35",
       "poissons_ratio = 0.5",
       11,
       "material.poissons_ratio",
       {"is 0.5", "below 0.5", "ogden"}},
      {"poissons_ratio = 0.35",
       "poissons_ratio = -1.0",
       11,
       "material.poissons_ratio",
       {"is -1.0", "above -1"}},
      {"poissons_ratio = 0.35",
       "poissons_ratio = 0.35\nmu = [1]",
       12,
       "material.mu",
       {"is not a key here", "youngs_modulus"}},
      {material,
       "model = 'ogden'\nmu = [0.1, 0.1]\nalpha = [2]\n",
       11,
       "material.alpha",
       {"is [2]", "as many", "2"}},
      {material, "model = 'ogden'\nmu = [0.1, -0.1]\nalpha = [2, 4]\n", 10, "material.mu", {"sum above 0"}},
      {material, "model = 'ogden'\nmu = [0.1]\nalpha = [0.0]\n", 11, "material.alpha", {"none 0"}},
      {material, "model = 'ogden'\nmu = []\nalpha = []\n", 10, "material.mu", {"one or more"}},
      {material,
       "model = 'ogden'\nmu = [0.1]\nalpha = [2]\nbulk_modulus = -3\n",
       12,
       "material.bulk_modulus",
       {"is -3"}},
      {material,
       "model = 'ogden'\nmu = [0.1]\nalpha = [2]\npoissons_ratio = 0.4\n",
       12,
       "material.poissons_ratio",
       {"is not a key here", "bulk_modulus"}},
  });
}

TEST_CASE("a mistake in [[region_material]] is refused where it is made") {
  check_mistakes({
      {"[[fixed]]",
       "[[region_material]]\n[[fixed]]",
       12,
       "region_material[0].axis",
       {"is missing", "one of group, box"}},
      {"[[fixed]]",
       "[[region_material]]\naxis = 'z'\n[[fixed]]",
       12,
       "region_material[0].from",
       {"is missing", "where the layer ends"}},
      {"[[fixed]]",
       "[[region_material]]\naxis = 'z'\nfrom = 8\nto = 8\n[[fixed]]",
       15,
       "region_material[0].to",
       {"above from"}},
      {"[[fixed]]",
       "[[region_material]]\nbox = [[0, 0, 0], [1, 1, 0]]\n[[fixed]]",
       13,
       "region_material[0].box",
       {"two corners, the lower first"}},
      {"[[fixed]]",
       "[[region_material]]\ngroup = 'fat'\n[[fixed]]",
       13,
       "region_material[0].group",
       {"shape = \"mesh\""}},
      {"[[fixed]]",
       "[[region_material]]\naxis = 'z'\nfrom = 8\nmodel = 'ogden'\nmu = [1]\nalpha = [2]\n[[fixed]]",
       15,
       "region_material[0].model",
       {"is \"ogden\"", "\"linear_elastic\" as in [material]"}},
  });
}
