#include "cases/scene/world.hpp"

#include <fmt/format.h> // before a namespace is called compare

#include "compare/gates/comparison.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/pictures.hpp"
#include "tests/support/tool_surfaces.hpp"

#include <Eigen/Geometry>

using namespace springproof;

using namespace cases;
using namespace pictures;
using Catch::Contains;
using Eigen::Matrix3d, Eigen::Matrix3f, Eigen::Vector3d, Eigen::Vector3f;

namespace {

const Eigen::Quaternionf askew(Eigen::AngleAxisf(0.4F, Vector3f(1, -2, 0.5F).normalized()));
const Vector3f offset(-87.5F, 120.25F, -31), elsewhere(11, 12, 13), voxel(1, 2, 3);
const Matrix3f askew_steps = askew.toRotationMatrix() * voxel.asDiagonal();
const Matrix3f mirror = Vector3f(-1, 1, 1).asDiagonal();

/// The rotation of a quaternion as the standard has it (nifti1.h, method 2), from its last three numbers.
Matrix3d method_2(const Vector3f& quaternion) {
  const double b = quaternion.x(), c = quaternion.y(), d = quaternion.z(),
               a = std::sqrt(std::max(0., 1 - (b * b + c * c + d * d)));
  Matrix3d r;
  r << a * a + b * b - c * c - d * d, 2 * b * c - 2 * a * d, 2 * b * d + 2 * a * c, //
      2 * b * c + 2 * a * d, a * a + c * c - b * b - d * d, 2 * c * d - 2 * a * b,  //
      2 * b * d - 2 * a * c, 2 * c * d + 2 * a * b, a * a + d * d - c * c - b * b;
  return r;
}

Labels in_world(const std::string& path) {
  Labels labels = bone_and_fat(1, path);
  labels.classes[0].is_rigid = false;
  labels.frame = Frame::world;
  return labels;
}

std::string world_refusal(const std::string& content) {
  const TemporaryFolder folder;
  try {
    placement_of(in_world(folder.write("a.nii", content)));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

/// A case whose points, directions and boxes are those of the body's own coordinates, or the same of the
/// world.
struct Text {
  std::optional<Placement> placement{}; ///< absent: the body's own

  static std::string shown(const Vector3d& v) { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }
  Vector3d turned(const Vector3d& v) const {
    return placement ? Vector3d(placement->axes[0] * v.x() + placement->axes[1] * v.y() +
                                placement->axes[2] * v.z())
                     : v;
  }
  Vector3d moved(const Vector3d& p) const { return placement ? Vector3d(placement->corner + turned(p)) : p; }
  std::string direction(double x, double y, double z) const { return shown(turned({x, y, z})); }
  std::string point(double x, double y, double z) const { return shown(moved({x, y, z})); }
  std::string box(const Vector3d& lower, const Vector3d& upper) const {
    const Vector3d a = moved(lower), b = moved(upper);
    return "[" + shown(a.cwiseMin(b)) + ", " + shown(a.cwiseMax(b)) + "]";
  }
  std::string whole(const std::string& crop, const std::string& more) const {
    return "schema = 1\nname = 'turned'\n[body]\nshape = 'labels'\nfile = 'a.nii'\nedge = 1\nframe = '" +
           std::string(placement ? "world" : "grid") + "'\n" + crop + "keep = " + point(1.5, 1.5, 1.5) +
           "\n[[body.classes]]\nname = 'bone'\nlower = 80\nupper = 120\n"
           "[[body.classes]]\nname = 'fat'\nlower = 40\nupper = 60\n"
           "[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.3\n"
           "[[fixed]]\nregion = { class = 'bone', beyond = { point = " +
           point(0.5, 1, 2) + ", normal = " + direction(-1, 0, 0) +
           " } }\n[[moved]]\nnear = " + point(9, 3, 3) +
           "\nradius = 1.5\nangle = 5\naxis = " + direction(1, 0, 0) + "\ncentre = " + point(9, 3, 3) +
           "\n[[load]]\nregion = { plane = { point = " + point(1, 1, 6) + ", normal = " + direction(0, 0, 1) +
           ", tolerance = 0.1 } }\nkind = 'traction'\nvalue = " + direction(0, 0.001, 0.0005) +
           "\n[[load]]\nnearest = " + point(5.1, 3, 0.1) +
           "\ntolerance = 0.5\nkind = 'nodal_force'\nvalue = " + direction(0.002, 0, 0.01) +
           "\n[[load]]\nregion = { plane = { point = " + point(2, 6, 2) + ", normal = " + direction(0, 1, 0) +
           ", tolerance = 0.1 } }\nkind = 'torque'\nvalue = 0.05\naxis = " + direction(0, 1, 0) +
           "\ncentre = " + point(4.5, 6, 3) +
           "\n[fem]\naccuracy = 'none'\n[[measure]]\nname = 'inside'\nkind = " + "'displacement'\nat = " +
           point(4.2, 2.2, 3.3) +
           "\ncomponent = 'x'\n[[measure]]\nname = 'stress'\nkind = 'stress'\ncomponent = 'xy'\npoint = " +
           point(3.5, 2.5, 1.5) + "\n[[landmark]]\nname = 'top'\npoint = " + point(3.1, 2.9, 6) + "\n" + more;
  }
};

Scene scene_of(const std::string& text, const TemporaryFolder& folder) {
  return make_scene(read_case(folder.write("case.toml", text)));
}

void check_same_answer(const std::string& in_grid, const std::string& in_world,
                       const TemporaryFolder& folder) {
  const auto answered = [&](const std::string& text) {
    return compare::compare_case(read_case(folder.write("case.toml", text)));
  };
  const compare::Comparison grid = answered(in_grid), world = answered(in_world);
  const auto check = [](const compare::Answer& expected, const compare::Answer& found) {
    REQUIRE(expected.converged());
    REQUIRE(found.converged());
    double largest = 0, apart = 0;
    for (std::size_t n = 0; n < expected.solution.displacement.size(); ++n) {
      largest = std::max(largest, expected.solution.displacement[n].norm());
      apart = std::max(apart, (found.solution.displacement.at(n) - expected.solution.displacement[n]).norm());
    }
    CHECK(largest > 1e-3);
    CHECK(apart <= 1e-12 * largest); // rounding of the points, times the body's condition
  };
  check(grid.answers.fem, world.answers.fem);
  check(grid.answers.msm, world.answers.msm);
  REQUIRE(world.measures.size() == 2);
  for (std::size_t m = 0; m < 2; ++m)
    CHECK(world.measures[m].msm.value() == Approx(grid.measures[m].msm.value()).epsilon(1e-10));
  const auto landmark = [](const compare::Comparison& of) {
    return of.scene.definition.landmarks.at(0).point;
  };
  CHECK((landmark(world) - landmark(grid)).norm() < 1e-12);
  REQUIRE(world.scene.remarks.size() == grid.scene.remarks.size() + 1);
  CHECK_THAT(world.scene.remarks[0], Contains("frame = \"world\", by the sform of code 1"));
}

} // namespace

TEST_CASE("a voxel of a turned picture is where its file says in the world", "[verification]") {
  // Two voxels of a body that share no face; the point of either keeps it.
  Volume volume{{5, 4, 3}, {1, 2, 3}, std::vector<float>(60, 0)};
  const std::array<Vector3d, 2> voxels{Vector3d(1, 2, 0), Vector3d(4, 0, 2)};
  for (const Vector3d& at : voxels)
    volume.intensities[static_cast<std::size_t>(at.x() + 5 * (at.y() + 4 * at.z()))] = 50;
  const auto file = [&] { return Nifti(nifti_of(volume)); };
  const Matrix3f none = Matrix3f::Zero();
  const Vector3f b_c_d = askew.vec(), half_turn(0.6F, 0.8F, 0);
  const Matrix3d turned = method_2(b_c_d) * voxel.cast<double>().asDiagonal(),
                 reversed = method_2(b_c_d) * Vector3d(1, 2, -3).asDiagonal();
  struct Form {
    std::string name, content;
    bool is_by_sform;
    Matrix3d steps;
  };
  const Matrix3d by_sform = askew_steps.cast<double>();
  const std::vector<Form> forms{
      {"sform", file().map(1, askew_steps, 0, offset), true, by_sform},
      {"left-handed sform", file().map(2, askew_steps * mirror, 0, offset), true,
       by_sform * mirror.cast<double>()},
      {"qform", file().map(0, none, 1).turn(1, b_c_d, offset), false, turned},
      {"left-handed qform", file().map(0, none, 1).turn(-1, b_c_d, offset), false, reversed},
      {"half a turn", file().map(0, none, 1).turn(1, half_turn, offset), false,
       method_2(half_turn) * voxel.cast<double>().asDiagonal()},
      {"both", file().map(1, askew_steps, 1, offset).turn(1, {0, 0, 0}, elsewhere), true, by_sform},
      {"an atlas beside the scanner", file().map(4, askew_steps, 1, elsewhere).turn(1, b_c_d, offset), false,
       turned},
      {"an atlas alone", file().map(4, askew_steps, 0, offset), true, by_sform}};
  const TemporaryFolder folder;
  for (const Form& form : forms) {
    CAPTURE(form.name);
    Labels labels = in_world(folder.write("a.nii", form.content));
    labels.classes.erase(labels.classes.begin());
    labels.keep = Keep::seed;
    const Placement placement = placement_of(labels);
    CHECK(placement.is_by_sform == form.is_by_sform);
    for (const Vector3d& at : voxels) {
      labels.seed = form.steps * at + offset.cast<double>();
      const Mesh mesh = make_label_mesh(on_grid(labels, placement));
      CHECK(mesh.cells.size() == 6);
      const Vector3d centre = (mesh.nodes[0] + mesh.nodes[mesh.nodes.size() - 1]) / 2;
      CHECK((placement.to_body(labels.seed) - centre).norm() < 2e-5); // 120 mm in single precision
    }
  }
}

TEST_CASE("a file in another unit and a scaled body keep their place", "[verification]") {
  const TemporaryFolder folder;
  const Vector3d centre = askew_steps.cast<double>() * Vector3d(2, 1, 1) + offset.cast<double>(),
                 at(2.5, 3, 4.5);
  Labels labels = in_world(
      folder.write("a.nii", Nifti().lengths(1e-3).units(1).map(1, askew_steps * 1e-3F, 0, offset * 1e-3F)));
  CHECK((placement_of(labels).to_body(centre) - at).norm() < 2e-5);
  labels.scale = 2;
  CHECK((placement_of(labels).to_body(2 * centre) - 2 * at).norm() < 4e-5);
}

TEST_CASE("a case in the world has the answer of the same case on the grid", "[verification]") {
  const TemporaryFolder folder;
  SECTION("of a picture that lies askew") {
    const std::string path = folder.write("a.nii", Nifti().map(1, askew_steps, 0, offset));
    const Text world{placement_of(in_world(path))};
    check_same_answer(Text{}.whole("", ""), world.whole("", ""), folder);
  }
  SECTION("of one along the axes of the world, in another order: boxes and single components too") {
    Matrix3f along;
    along << 0, 0, -1, 1, 0, 0, 0, -1, 0; // x, y, z of the array are y, -z, -x of the world
    const std::string path = folder.write("a.nii", Nifti().map(1, along * voxel.asDiagonal(), 0, offset));
    const Text world{placement_of(in_world(path))};
    const auto text = [&](const Text& one) {
      return one.whole("crop = " + one.box({-1, 0, 0}, {9, 6, 6}) + "\n",
                       "[[body.removed]]\nbox = " + one.box({3, 0, 0}, {5, 2, 2}) +
                           "\n[[region_material]]\nbox = " + one.box({5, 0, 0}, {9, 6, 4}) +
                           "\nmodel = 'linear_elastic'\nyoungs_modulus = 0.1\npoissons_ratio = "
                           "0.3\n[[moved]]\nregion = { box = " +
                           one.box({6, 0, 0}, {7, 0, 6}) +
                           " }\ncomponents = ['z']\ndisplacement = " + one.direction(0, 0, 0.2) + "\n");
    };
    check_same_answer(text(Text{}), text(world), folder);
  }
}

TEST_CASE("a box of the world is refused where the picture lies askew, and a crop covers it") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.nii", Nifti().map(1, askew_steps, 0, offset));
  const Text world{placement_of(in_world(path))};
  for (const std::string& table :
       {std::string("[[region_material]]\nbox = [[-99, 0, -99], [0, 200, 0]]\nmodel = 'linear_elastic'\n"
                    "youngs_modulus = 1\npoissons_ratio = 0.3\n"),
        std::string(
            "[[region_material]]\naxis = 'z'\nfrom = 0\nmodel = 'linear_elastic'\nyoungs_modulus = 1\n"
            "poissons_ratio = 0.3\n"),
        std::string("[[body.removed]]\nbox = [[-99, 0, -99], [0, 200, 0]]\n"),
        std::string("[[fixed]]\nregion = { box = [[-99, 0, -99], [0, 200, 0]] }\n")})
    CHECK_THROWS_WITH(scene_of(world.whole("", table), folder),
                      Contains("lies askew") && Contains("case.toml:"));
  CHECK_THROWS_WITH(scene_of(world.whole("", "[[moved]]\nnear = " + world.point(6, 0, 0) +
                                                 "\ncomponents = ['x']\ndisplacement = [1, 0, 0]\n"),
                             folder),
                    Contains("must be 0 in the components that are not moved"));
  Labels labels = in_world(path);
  labels.crop = {Vector3d(-90, 115, -35), Vector3d(-80, 125, -25)};
  const Labels cropped = on_grid(labels, *world.placement);
  const Eigen::AlignedBox3d covered(cropped.crop->at(0), cropped.crop->at(1)),
      box(labels.crop->at(0), labels.crop->at(1));
  Eigen::AlignedBox3d least;
  for (int corner = 0; corner < 8; ++corner)
    least.extend(world.placement->to_body(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner))));
  CHECK(covered.isApprox(least));
}

TEST_CASE("a surface of a case in the world is read in its coordinates") {
  const TemporaryFolder folder;
  const Text world{placement_of(in_world(folder.write("a.nii", Nifti().map(1, askew_steps, 0, offset))))};
  const auto corner = [&](const Vector3d& p) {
    const Vector3d at = world.moved(p);
    return fmt::format("vertex {} {} {}\n", at.x(), at.y(), at.z());
  };
  folder.write("skin.stl", "solid s\nfacet normal 0 0 0\nouter loop\n" + corner({1, 1, 6}) +
                               corner({3, 1, 6}) + corner({1, 3, 6}) + "endloop\nendfacet\nendsolid s\n");
  const TriangleMesh surface = scene_of(world.whole("", "[surface]\nfile = 'skin.stl'\n"), folder).surface;
  REQUIRE(surface.vertices.size() == 3);
  CHECK((surface.vertices[1] - Vector3d(3, 1, 6)).norm() < 2e-5); // single precision
}

TEST_CASE("a tool of a case in the world is where its file has it") {
  const TemporaryFolder folder;
  const Text world{placement_of(in_world(folder.write("a.nii", Nifti().map(1, askew_steps, 0, offset))))};
  const Surface on_grid = tool_surfaces::box({1, 1, 6}, {3, 2, 9});
  Surface moved = on_grid;
  for (auto& triangle : moved)
    for (Vector3d& at : triangle) at = world.moved(at);
  folder.write("tool.stl", tool_surfaces::stl(moved));
  const Scene scene =
      scene_of(world.whole("", "[[tool]]\nname = 'tool'\nshape = 'surface'\nfile = 'tool.stl'\n"), folder);
  const Tool& tool = scene.definition.tools.at(0);
  const auto& found = std::get<tools::Surface>(tool.shape).vertices;
  const auto expected = joined(on_grid).vertices;
  REQUIRE(found.size() == expected.size());
  for (std::size_t v = 0; v < found.size(); ++v)
    CHECK((tool.at + found[v] - expected[v]).norm() < 5e-5); // single precision
}

TEST_CASE("a map to the world that is no place of a body is refused") {
  Matrix3f sheared = askew_steps, singular = askew_steps;
  sheared.col(1) += 0.1F * sheared.col(0);
  singular.col(2).setZero();
  CHECK_THAT(world_refusal(Nifti()), Contains("sform_code and qform_code are 0: leave frame out"));
  CHECK_THAT(world_refusal(Nifti().map(1, sheared)), Contains("sheared"));
  CHECK_THAT(world_refusal(Nifti().map(1, singular)), Contains("1 x 2 x 0 by its sform"));
  CHECK_THAT(world_refusal(Nifti().map(1, 1.01F * askew_steps)), Contains("by its sform"));
  CHECK_THAT(world_refusal(Nifti().map(1, askew_steps * mirror, 1).turn(1, askew.vec(), offset)),
             Contains("mirrors"));
  CHECK_THAT(world_refusal(Nifti().map(0, askew_steps, 1).turn(1, {0.9F, 0.9F, 0}, offset)),
             Contains("no rotation"));
  CHECK_THAT(world_refusal(Nifti().map(0, askew_steps, 1).turn(1, {NAN, 0, 0}, offset)),
             Contains("no rotation"));
  CHECK_THAT(world_refusal(Nifti().map(1, askew_steps, 0, {0, INFINITY, 0})), Contains("that is none"));
}

TEST_CASE("frame is refused where nothing has world coordinates") {
  using case_text::check_refused;
  const auto read = [](const std::string& path) { read_case(path); };
  const std::string labels = Text{}.whole("", "");
  check_refused(
      case_text::replaced(case_text::good_case, "shape = 'box'\n", "shape = 'box'\nframe = 'world'\n"), 6,
      "body.frame", {"only the picture of shape = \"labels\""}, read);
  check_refused(case_text::replaced(labels, "'grid'", "'scanner'"), 7, "body.frame", {"\"grid\" | \"world\""},
                read);
  const std::string project = case_text::replaced(labels, "a.nii", "a.inv3");
  check_refused(case_text::replaced(project, "'grid'", "'world'"), 7, "body.frame", {"InVesalius"}, read);
  const TemporaryFolder folder;
  folder.write("n.csv", "0,0,0\n1,0,0\n");
  folder.write("s.csv", "0,1,9\n");
  const std::string network = folder.write(
      "case.toml", "schema = 1\nname = 'n'\n[body]\nshape = 'network'\nnodes = 'n.csv'\nsprings = 's.csv'\n"
                   "[fem.body]\nshape = 'labels'\nfile = 'a.nii'\nedge = 1\nframe = 'world'\n"
                   "[[fem.body.classes]]\nname = 'bone'\nlower = 80\nupper = 120\n");
  CHECK_THROWS_WITH(read_case(network),
                    Contains("case.toml:11:") && Contains("fem.body.frame") && Contains("\"grid\" here"));
}

TEST_CASE("a fibre of the world that lies along an axis of the array has springs by axis") {
  const TemporaryFolder folder;
  const Text world{placement_of(in_world(folder.write("a.nii", Nifti().map(1, askew_steps, 0, offset))))};
  const auto text = [&](const std::string& fibre) {
    return case_text::replaced(world.whole("", "[msm]\ndesign = 'transverse'\n"),
                               "'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.3\n",
                               "'transversely_isotropic'\nyoungs_modulus_along = 0.3\nyoungs_modulus_across "
                               "= 0.1\nshear_modulus_along = 0.04\n"
                               "poissons_ratio_along = 0.3\npoissons_ratio_across = 0.3\nfibre = " +
                                   fibre + "\n");
  };
  const Scene scene = scene_of(text(world.direction(0, 1, 0)), folder);
  CHECK(axis_along(std::get<TransverselyIsotropic>(scene.definition.material).fibre) == Axis::y);
  compare::Request springs_alone;
  springs_alone.only = Side::msm;
  folder.write("case.toml", text("'y'"));
  CHECK_THROWS_WITH(compare::compare_case(read_case((folder.path / "case.toml").string()), springs_alone),
                    Contains("material.fibre is"));
}
