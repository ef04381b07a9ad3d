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

TEST_CASE("neo-Hookean and Mooney-Rivlin materials are Ogden's by other names") {
  const std::string material = "model = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n";
  const auto ogden = [&](const std::string& text) {
    const std::string hyperelastic =
        replaced(good_case, "formulation = 'log_strain'", "formulation = 'hyperelastic'");
    return std::get<Ogden>(read_text(replaced(hyperelastic, material, text)).material);
  };
  const Ogden neo_hookean = ogden("model = 'neo_hookean'\nshear_modulus = 0.3\nbulk_modulus = 2\n");
  CHECK(neo_hookean.mu == std::vector<double>{0.3});
  CHECK(neo_hookean.alpha == std::vector<double>{2});
  CHECK(neo_hookean.bulk_modulus == 2);
  const Ogden mooney_rivlin = ogden("model = 'mooney_rivlin'\nc10 = 0.1\nc01 = 0.05\nbulk_modulus = 2\n");
  CHECK(mooney_rivlin.mu == std::vector<double>{0.2, 0.1});
  CHECK(mooney_rivlin.alpha == std::vector<double>{2, -2});
  const auto refused = mistakes_in(good_case);
  refused(material, "model = 'mooney_rivlin'\nc10 = 0.1\nc01 = -0.2\n", 11, "material.c01", {"above 0"});
  refused(material, "model = 'neo_hookean'\nmu = 0.1\n", 8, "material.shear_modulus", {"missing"});
}

TEST_CASE("a Yeoh material has one to three coefficients, and the first is above 0") {
  const std::string material = "model = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n";
  const std::string hyperelastic =
      replaced(good_case, "formulation = 'log_strain'", "formulation = 'hyperelastic'");
  const auto yeoh = [&](const std::string& text) {
    return std::get<Yeoh>(read_text(replaced(hyperelastic, material, "model = 'yeoh'\n" + text)).material);
  };
  const Yeoh one = yeoh("c10 = 0.1\n"),
             three = yeoh("c10 = 0.1\nc20 = -0.02\nc30 = 0.01\nbulk_modulus = 2\n");
  CHECK(one.c10 == 0.1);
  CHECK((one.c20 == 0 && one.c30 == 0 && !one.bulk_modulus));
  CHECK((three.c20 == -0.02 && three.c30 == 0.01 && three.bulk_modulus == 2));
  CHECK(poissons_ratio_of(one) == 0.5);
  CHECK(poissons_ratio_of(three) == Approx((3 * 2 - 2 * 0.2) / (2 * (3 * 2 + 0.2))));
  const auto refused = mistakes_in(hyperelastic);
  refused(material, "model = 'yeoh'\nc10 = 0\nc20 = 1\n", 10, "material.c10", {"above 0"});
  refused(material, "model = 'yeoh'\nc20 = 1\n", 8, "material.c10", {"missing"});
  refused(material, "model = 'yeoh'\nc10 = 1\nc40 = 1\n", 11, "material.c40", {"is not a key"});
  mistakes_in(good_case)(material, "model = 'yeoh'\nc10 = 1\n", 18, "fem.formulation", {"hyperelastic"});
}

TEST_CASE("a mistake in [material] is refused where it is made") {
  const std::string material = "model = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n";
  const auto refused = mistakes_in(good_case);
  refused("model = 'linear_elastic'", "model = 'linear_elastik'", 9, "material.model",
          {"\"linear_elastic\" | \"ogden\" | \"transversely_isotropic\" | \"yeoh\"",
           "did you mean \"linear_elastic\"?"});
  refused("youngs_modulus = 0.3", "youngs_modulus = 0", 10, "material.youngs_modulus",
          {"is 0", "above 0 (MPa)"});
  refused("youngs_modulus = 0.3", "youngs_modulus = 1e-300", 10, "material.youngs_modulus",
          {"from 1e-12 to 1e12"});
  refused("youngs_modulus = 0.3", "youngs_modulus = 1e13", 10, "material.youngs_modulus",
          {"from 1e-12 to 1e12"});
  refused("youngs_modulus = 0.3", "youngs_modulus = inf", 10, "material.youngs_modulus",
          {"is inf", "above 0 (MPa)"});
  refused("youngs_modulus = 0.3", "youngs_modulus = 'soft'", 10, "material.youngs_modulus",
          {"is \"soft\"", "a number"});
  refused("youngs_modulus = 0.3", "young_modulus = 0.3", 10, "material.young_modulus",
          {"did you mean \"youngs_modulus\"?"});
  refused("poissons_ratio = 0.35", "poissons_ratio = 0.5", 11, "material.poissons_ratio",
          {"is 0.5", "below 0.5", "ogden"});
  refused("poissons_ratio = 0.35", "poissons_ratio = -1.0", 11, "material.poissons_ratio",
          {"is -1.0", "above -1"});
  refused("poissons_ratio = 0.35", "poissons_ratio = 0.35\nmu = [1]", 12, "material.mu",
          {"is not a key here", "youngs_modulus"});
  refused(material, "model = 'ogden'\nmu = [0.1, 0.1]\nalpha = [2]\n", 11, "material.alpha",
          {"is [2]", "as many", "2"});
  refused(material, "model = 'ogden'\nmu = [0.1, -0.1]\nalpha = [2, 4]\n", 10, "material.mu",
          {"sum above 0"});
  refused(material, "model = 'ogden'\nmu = [0.1]\nalpha = [0.0]\n", 11, "material.alpha", {"none 0"});
  refused(material, "model = 'ogden'\nmu = []\nalpha = []\n", 10, "material.mu", {"one or more"});
  refused(material, "model = 'ogden'\nmu = [0.1]\nalpha = [2]\nbulk_modulus = -3\n", 12,
          "material.bulk_modulus", {"is -3"});
  refused(material, "model = 'ogden'\nmu = [0.1]\nalpha = [2]\npoissons_ratio = 0.4\n", 12,
          "material.poissons_ratio", {"is not a key here", "bulk_modulus"});
}

namespace {

const std::string isotropic_text = "model = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n",
                  fibrous_text =
                      "model = 'transversely_isotropic'\nyoungs_modulus_along = 0.3\n"
                      "youngs_modulus_across = 0.1\nshear_modulus_along = 0.05\n"
                      "poissons_ratio_along = 0.4\npoissons_ratio_across = 0.5\nfibre = [0, 3, 4]\n",
                  designed_text = "design = 'moduli'\npoissons_ratio = 0.3\nsplit = 0.8\n",
                  given_text = "design = 'given'\nstiffness = [1, 1, 1]\n";

} // namespace

TEST_CASE("a transversely isotropic material is read") {
  const std::string text =
      replaced(replaced(good_case, isotropic_text, fibrous_text), designed_text, given_text);
  const auto material = std::get<TransverselyIsotropic>(read_text(text).material);
  CHECK(material.youngs_modulus_along == 0.3);
  CHECK(material.youngs_modulus_across == 0.1);
  CHECK(material.shear_modulus_along == 0.05);
  CHECK(material.poissons_ratio_along == 0.4);
  CHECK(material.poissons_ratio_across == 0.5);
  CHECK((material.fibre - Eigen::Vector3d(0, 0.6, 0.8)).norm() <= 1e-15);
  const auto along_z = read_text(replaced(text, "[0, 3, 4]", "'z'"));
  CHECK(std::get<TransverselyIsotropic>(along_z.material).fibre == Eigen::Vector3d::UnitZ());
  CHECK(along_z.fem.formulation == Formulation::log_strain);

  const auto in_text = [&](const std::string& from, const std::string& to) {
    return read_text(replaced(text, from, to));
  };
  CHECK_THROWS_WITH(in_text("'log_strain'", "'saint_venant_kirchhoff'"),
                    Catch::Contains("fem.formulation") &&
                        Catch::Contains("\"small_strain\" | \"log_strain\" with model = "
                                        "\"transversely_isotropic\""));
  CHECK_NOTHROW(in_text("'log_strain'", "'small_strain'"));
}

TEST_CASE("a transversely isotropic material has designs of its own") {
  const std::string askew = replaced(replaced(good_case, isotropic_text, fibrous_text), designed_text, ""),
                    along_z = replaced(askew, "[0, 3, 4]", "'z'");
  // the default is refused when springs are asked for
  for (const std::string& text : {askew, along_z}) CHECK(read_text(text).msm.design == Design::transverse);
  const auto with_design = [](const std::string& text, const std::string& design) {
    return read_text(replaced(text, "[msm]\n", "[msm]\ndesign = '" + design + "'\n"));
  };
  CHECK_NOTHROW(with_design(along_z, "transverse"));
  CHECK_THROWS_WITH(with_design(askew, "transverse"),
                    Catch::Contains("msm.design") && Catch::Contains("lies along no axis of the grid"));
  CHECK_THROWS_WITH(
      with_design(along_z, "hybrid"),
      Catch::Contains("msm.design") &&
          Catch::Contains("must be \"midline\" | \"transverse\" | \"given\" | \"network\" with model = "
                          "\"transversely_isotropic\""));
  const std::string isotropic = replaced(good_case, designed_text, "design = 'transverse'\n");
  CHECK_THROWS_WITH(read_text(isotropic), Catch::Contains("msm.design") && Catch::Contains("\"hybrid\"") &&
                                              Catch::Contains("with model = \"linear_elastic\""));
}

TEST_CASE("a transversely isotropic material must store energy in every strain") {
  const auto mistake = [](const std::string& from, const std::string& to, const std::string& key,
                          const std::string& bound) {
    const std::string text =
        replaced(replaced(good_case, isotropic_text, fibrous_text), designed_text, given_text);
    CAPTURE(to);
    CHECK_THROWS_WITH(read_text(replaced(text, from, to)),
                      Catch::Contains("material." + key + ": ") && Catch::Contains(bound));
  };
  mistake("youngs_modulus_along = 0.3", "youngs_modulus_along = 0", "youngs_modulus_along", "above 0 (MPa)");
  mistake("youngs_modulus_across = 0.1", "youngs_modulus_across = -1", "youngs_modulus_across",
          "above 0 (MPa)");
  mistake("shear_modulus_along = 0.05", "shear_modulus_along = nan", "shear_modulus_along", "above 0 (MPa)");
  mistake("poissons_ratio_across = 0.5", "poissons_ratio_across = 1", "poissons_ratio_across", "below 1");
  mistake("poissons_ratio_across = 0.5", "poissons_ratio_across = -1", "poissons_ratio_across", "above -1");
  // sqrt(0.5 * 0.3/(2 * 0.1))
  mistake("poissons_ratio_along = 0.4", "poissons_ratio_along = 0.8661", "poissons_ratio_along",
          "b = 0.866025");
  mistake("poissons_ratio_along = 0.4", "poissons_ratio_along = -0.8661", "poissons_ratio_along",
          "b = 0.866025");
  mistake("fibre = [0, 3, 4]", "fibre = [0, 0, 0]", "fibre", "not all 0");
  mistake("fibre = [0, 3, 4]", "", "fibre", "is missing");
}

TEST_CASE("a mistake in [[region_material]] is refused where it is made") {
  const auto refused = mistakes_in(good_case);
  refused("[[fixed]]", "[[region_material]]\n[[fixed]]", 12, "region_material[0].axis",
          {"is missing", "one of class, group, box"});
  refused("[[fixed]]", "[[region_material]]\naxis = 'z'\n[[fixed]]", 12, "region_material[0].from",
          {"is missing", "where the layer ends"});
  refused("[[fixed]]", "[[region_material]]\naxis = 'z'\nfrom = 8\nto = 8\n[[fixed]]", 15,
          "region_material[0].to", {"above from"});
  refused("[[fixed]]", "[[region_material]]\nbox = [[0, 0, 0], [1, 1, 0]]\n[[fixed]]", 13,
          "region_material[0].box", {"two corners, the lower first"});
  refused("[[fixed]]", "[[region_material]]\ngroup = 'fat'\n[[fixed]]", 13, "region_material[0].group",
          {"shape = \"mesh\""});
  refused("[[fixed]]",
          "[[region_material]]\naxis = 'z'\nfrom = 8\nmodel = 'ogden'\nmu = [1]\nalpha = [2]\n[[fixed]]", 15,
          "region_material[0].model", {"is \"ogden\"", "\"linear_elastic\" as in [material]"});
}
