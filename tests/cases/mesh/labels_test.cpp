#include "cases/mesh/labels.hpp"

#include "cases/scene/scene.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/pictures.hpp"

using namespace springproof;

using namespace cases;
using namespace pictures;
using Catch::Contains;
using Eigen::Vector3d;

TEST_CASE("a cell has the class that fills most of it and what is outside of the picture is empty") {
  const Volume volume = picture();
  SECTION("cells of the size of some voxels") {
    const LabelGrid grid = label_cells(volume, bone_and_fat(2));
    CHECK(grid.cells == std::array<int, 3>{6, 3, 3});
    // The fifth cell along x has half fat and half nothing: a class wins over none.
    for (std::size_t c = 0; c < grid.class_of_cell.size(); ++c)
      CHECK(grid.class_of_cell[c] == (c % 6 < 3 ? 1 : c % 6 < 5 ? 2 : 0));
  }
  SECTION("cells that are smaller than voxels") {
    const LabelGrid grid = label_cells(volume, bone_and_fat(0.5));
    CHECK(std::count(grid.class_of_cell.begin(), grid.class_of_cell.end(), 1) == 12 * 12 * 12);
    CHECK(std::count(grid.class_of_cell.begin(), grid.class_of_cell.end(), 2) == 6 * 12 * 12);
  }
  SECTION("one that reaches far out") {
    CHECK(label_cells(volume, bone_and_fat(8)).class_of_cell[0] == 0);   // 216 of 512 mm³ are bone, 72 fat
    CHECK(label_cells(volume, bone_and_fat(7.5)).class_of_cell[0] == 1); // 216 of 422
  }
  SECTION("a crop, which need not lie on voxels") {
    Labels labels = bone_and_fat(1);
    labels.crop = {Vector3d(5.4, 0, 0), Vector3d(7.4, 1, 1)};
    const LabelGrid grid = label_cells(volume, labels);
    CHECK(grid.class_of_cell == std::vector<std::uint8_t>{1, 2}); // 0.6 of bone, 0.6 of fat
    labels.crop = {Vector3d(-9, -9, -9), Vector3d(-8, -8, -8)};
    CHECK(label_cells(volume, labels).class_of_cell == std::vector<std::uint8_t>{0});
  }
  SECTION("too many cells") {
    CHECK_THROWS_WITH(label_cells(volume, bone_and_fat(1e-3)), Contains("more than 5e+07"));
  }
}

TEST_CASE("one piece of a labelled body is kept, the largest or the one with a point") {
  Labels labels = bone_and_fat(1);
  const auto grid = [] { return LabelGrid{{5, 1, 1}, {0, 0, 0}, {1, 0, 1, 2, 0}}; };
  LabelGrid kept = grid();
  CHECK_THROWS_WITH(keep_piece(kept, labels), Contains("2 pieces") && Contains("keep = \"largest\""));
  labels.keep = Keep::largest;
  keep_piece(kept, labels);
  CHECK(kept.class_of_cell == std::vector<std::uint8_t>{0, 0, 1, 2, 0});
  labels.keep = Keep::seed;
  labels.seed = {0.5, 0.5, 0.5};
  kept = grid();
  keep_piece(kept, labels);
  CHECK(kept.class_of_cell == std::vector<std::uint8_t>{1, 0, 0, 0, 0});
  for (const Vector3d& nowhere : {Vector3d(1.5, 0.5, 0.5), Vector3d(-1, 0.5, 0.5), Vector3d(0.5, 9, 0.5)}) {
    labels.seed = nowhere;
    kept = grid();
    CHECK_THROWS_WITH(keep_piece(kept, labels), Contains("in no cell"));
  }
  kept = {{1, 1, 1}, {0, 0, 0}, {0}};
  CHECK_THROWS_WITH(keep_piece(kept, labels), Contains("no cell of edge 1 mm"));
}

TEST_CASE("the same picture in every format becomes the same cells") {
  const TemporaryFolder folder;
  const std::string voxels = bytes_of_picture<std::int16_t>();
  check_is_picture(folder.write("e.nii", nifti_of(picture())));
  check_is_picture(folder.write("f.nii", nifti({12, 3, 2}) + voxels));
  std::string halved;
  for (const float intensity : picture().intensities) {
    const auto number = static_cast<std::int16_t>((intensity + 20) / 2);
    halved.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  check_is_picture(folder.write("g.nii", nifti({12, 3, 2}, 2, -20) + halved));
  check_is_picture(folder.write("h.inv3", project(plist(), voxels)));
}

TEST_CASE("a broken picture is refused in one line") {
  const TemporaryFolder folder;
  const std::string voxels = bytes_of_picture<std::int16_t>();
  const auto refused = [&](const std::string& name, const std::string& content) {
    return refusal(bone_and_fat(1, folder.write(name, content)));
  };
  CHECK_THAT(refused("cut.nii", nifti({12, 3, 2}) + voxels.substr(0, 100)), !Contains("none"));
  CHECK_THAT(refused("cut.inv3", project(plist(), voxels).substr(0, 530)), Contains("is no gzipped tar"));
  CHECK_THAT(refused("huge.nii", nifti({2000, 2000, 2000}) + voxels), Contains("more than the"));
  CHECK_THAT(refused("huge.inv3",
                     project(plist("<integer>2000</integer><integer>2000</integer><integer>2000</integer>"),
                             voxels)),
             Contains("more than the"));
  CHECK_THAT(refused("less.inv3",
                     project(plist("<integer>2</integer><integer>3</integer><integer>3</integer>"), voxels)),
             Contains("144 bytes, which cannot be"));
  CHECK_THAT(refused("flat.nii", nifti({12, 0, 2}) + voxels), !Contains("none"));
  CHECK_THAT(refused("negative.nii", nifti({12, -3, 2}) + voxels), !Contains("none"));
  for (const char* name : {"none.nii", "none.nii.gz", "none.inv3"}) {
    CHECK_THAT(refused(name, "nothing of the kind"), Contains(name));
    CHECK_THAT(refused(name, ""), Contains(name));
  }
  CHECK_THAT(refusal(bone_and_fat(1, (folder.path / "absent.nii").string())), Contains("No such file"));
}

TEST_CASE("a cut picture is refused wherever it is cut") {
  const TemporaryFolder folder;
  const std::string voxels = bytes_of_picture<std::int16_t>();
  const std::vector<std::pair<std::string, std::string>> pictures{{"cut.nii", nifti({12, 3, 2}) + voxels},
                                                                  {"cut.inv3", project(plist(), voxels)}};
  for (const auto& [name, content] : pictures) {
    const std::size_t end = name == "cut.inv3" ? 3 * 512 + plist().size() : content.size(); // then zeros
    for (std::size_t bytes = 0; bytes < end; bytes += end / 11 + 1) {
      INFO(name << " of " << bytes << " bytes");
      CHECK_THAT(refusal(bone_and_fat(1, folder.write(name, content.substr(0, bytes)))), Contains(name));
    }
  }
}

TEST_CASE("a header that has a field of another kind is refused by its name") {
  const TemporaryFolder folder;
  const std::string voxels = bytes_of_picture<std::int16_t>();
  const auto with = [&](std::size_t at, auto value) {
    std::string content = nifti({12, 3, 2}) + voxels;
    std::memcpy(&content[at], &value, sizeof value);
    return refusal(bone_and_fat(1, folder.write("a.nii", content)));
  };
  CHECK_THAT(with(344, 'x'), Contains("magic word"));
  CHECK_THAT(with(345, 'i'), Contains("magic word")); // whose voxels are in another file
  CHECK_THAT(with(84, 0.F), Contains("must be above 0 mm"));
  CHECK_THAT(with(72, std::int16_t{64}), Contains("64 bits a voxel, its type has 16"));
  CHECK_THAT(with(112, NAN), Contains("is no number"));
}

TEST_CASE("a wrong order of bytes shows in the intensities that the refusal tells") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.nii", nifti({12, 3, 2}) + bytes_of_picture<std::int16_t>(true));
  CHECK_THAT(refusal(bone_and_fat(1, path)), Contains("intensities are from 0 to 25600")); // 100 is 0x64
}

TEST_CASE("a class without a cell is refused, and an edge larger than the body") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.nii", nifti_of(picture()));
  Labels labels = bone_and_fat(1, path);
  labels.classes.push_back({"skin", 200, 300, false});
  CHECK_THAT(refusal(labels), Contains("class 'skin', from 200 to 300, has no cell"));
  CHECK_THAT(refusal(bone_and_fat(100, path)), Contains("no cell of edge 100 mm"));
}

TEST_CASE("what a confined reader answers is believed only where it is a grid of known classes") {
  const LabelGrid grid{{2, 1, 1}, {0, 0, 0}, {1, 2}};
  CHECK(label_grid_from(bytes_of(grid), 2).class_of_cell == grid.class_of_cell);
  CHECK_THROWS(label_grid_from(bytes_of(grid), 1));
  CHECK_THROWS(label_grid_from(bytes_of(LabelGrid{{3, 1, 1}, {0, 0, 0}, {1, 2}}), 2));
  CHECK_THROWS(label_grid_from(bytes_of(LabelGrid{{-2, -1, 1}, {0, 0, 0}, {1, 2}}), 2));
  CHECK_THROWS(label_grid_from(bytes_of(LabelGrid{{2, 1, 1}, {0, 0, NAN}, {1, 2}}), 2));
  CHECK_THROWS(label_grid_from("", 2));
}

TEST_CASE("nodes of a rigid class are held where nothing moves them, on finer meshes too") {
  const TemporaryFolder folder;
  Case definition;
  definition.body = bone_and_fat(1, folder.write("a.nii", nifti_of(picture())));
  Moved lifted;
  lifted.region.name = "upper bone";
  lifted.region.part = Part{"bone", {0, 0, 5}, {9, 9, 9}};
  lifted.components = {false, false, true};
  lifted.displacement = {0, 0, 1};
  definition.moved.push_back(lifted);
  const Scene scene = make_scene(definition);
  CHECK(is_rigid(scene, 0));
  CHECK_FALSE(is_rigid(scene, 6));
  for (const int refined : {0, 1}) {
    const Scene finer = refine(scene, refined);
    const std::vector<bool> constrained = constrained_dofs(finer);
    for (std::size_t n = 0; n < finer.mesh.nodes.size(); ++n)
      for (std::size_t a = 0; a < 3; ++a)
        CHECK(constrained[3 * n + a] == (finer.mesh.nodes[n].x() <= 6)); // bone from x = 0 to 6
    std::size_t n_held = 0;
    for (const auto& held : finer.constrained) n_held += held.selection.nodes.size();
    CHECK(n_held > finer.moved[0].selection.nodes.size());
  }
}

TEST_CASE("a piece of a labelled body is removed and the cut joined where its rigid class holds the sides") {
  const TemporaryFolder folder;
  Volume layers{{12, 3, 5}, {1, 1, 1}, {}}; // bone 1 mm high under 4 mm of fat
  for (int v = 0; v < 12 * 3 * 5; ++v) layers.intensities.push_back(v < 12 * 3 ? 100 : 50);
  Case definition;
  definition.body = bone_and_fat(1, folder.write("a.nii", nifti_of(layers)));
  Removed piece;
  piece.lower = {5, 0, 0};
  piece.upper = {7, 3, 3};
  piece.join = Axis::x;
  definition.removed.push_back(piece);
  Moved setback;
  setback.region.name = "bone beyond the cut";
  setback.region.part = Part{"bone", {7, 0, 0}, {12, 3, 1}};
  setback.components = {true, true, true};
  setback.displacement = {-2, 0, 0};
  definition.moved.push_back(setback);
  const Scene scene = make_scene(definition);
  CHECK(scene.mesh.cells.size() == 12 * 3 * 5 - 2 * 3 * 3);
  CHECK(std::count(scene.mesh.group_of_cell.begin(), scene.mesh.group_of_cell.end(), "bone") == 10 * 3);
  const std::vector<bool> constrained = constrained_dofs(scene);
  for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
    const Vector3d& node = scene.mesh.nodes[n];
    const bool is_bone = node.z() <= 1, is_side = node.x() == 5 || node.x() == 7;
    CHECK(constrained[3 * n] == (is_bone || (is_side && node.z() == 2))); // cells are left over the cut at 3
    CHECK(constrained[3 * n + 1] == is_bone);
    CHECK(constrained[3 * n + 2] == is_bone);
  }
  REQUIRE(scene.moved.size() == 3);
  CHECK(scene.moved[1].motion.displacement == Vector3d(0, 0, 0)); // the lower side, held by its bone
  CHECK(scene.moved[2].motion.displacement == Vector3d(-2, 0, 0));
  definition.moved[0].displacement = {-1, 0, 0};
  CHECK_THROWS_WITH(make_scene(definition), Contains("its sides end 1 mm apart along x"));
}
