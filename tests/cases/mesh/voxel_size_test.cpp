#include "cases/mesh/voxel_size.hpp"

#include "tests/support/case_text.hpp"
#include "tests/support/pictures.hpp"

using namespace springproof;

using namespace cases;
using namespace pictures;
using Catch::Contains;

// Of the same kind were looked for: InVesalius's main.plist (mm, three numbers, no unit), images of VTK
// (.vti, whose direction is read: foreign_files_test.cpp), STL and gmsh (no units: body.scale), intensities'
// slopes (labels_test.cpp).

namespace {

const std::string picture_bytes = bytes_of_picture<std::int16_t>();

std::string with_spacings(const std::string& lines) {
  return case_text::replaced(nrrd(), "spacings: 1 2 3\n", lines) + picture_bytes;
}
std::string with_meta(const std::string& lines) {
  return case_text::replaced(meta("LOCAL"), "ElementSpacing = 1 2 3\n", lines) + picture_bytes;
}

/// A NIfTI file with some bytes of its header set.
class Nifti {
 public:
  template<class Value>
  Nifti& put(std::size_t at, Value value) {
    std::memcpy(&content_[at], &value, sizeof value);
    return *this;
  }
  Nifti& lengths(double by) {
    for (std::size_t a = 0; a < 3; ++a) put(80 + 4 * a, static_cast<float>(by * double(a + 1)));
    return *this;
  }
  Nifti& units(char code) { return put(123, code); }
  Nifti& map(std::int16_t sform, const Eigen::Matrix3f& steps, std::int16_t qform = 0) {
    put(252, qform).put(254, sform);
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t a = 0; a < 3; ++a) put(280 + 16 * row + 4 * a, steps(int(row), int(a)));
    return *this;
  }
  operator std::string() const { return content_; }

 private:
  std::string content_ = nifti({12, 3, 2}) + picture_bytes;
};

const Eigen::Matrix3f straight = Eigen::Vector3f(1, 2, 3).asDiagonal();

} // namespace

TEST_CASE("a picture whose file says another unit than mm is the same body", "[verification]") {
  const TemporaryFolder folder;
  check_is_picture(folder.write("a.nii", Nifti().lengths(1e-3).units(1)));     // metres
  check_is_picture(folder.write("b.nii", Nifti().lengths(1e3).units(3 | 16))); // micrometres and ms
  check_is_picture(folder.write("c.nii", Nifti().units(2)));
  check_is_picture(folder.write("d.nii", Nifti().units(8))); // none of length: mm
  check_is_picture(
      folder.write("a.nrrd", with_spacings("spacings: 1000 2e3 3000\nunits: \"um\" \"um\" \"um\"\n")));
  check_is_picture(folder.write(
      "b.nrrd",
      with_spacings("space: LPS\nspace directions: (.1,0,0) (0,0,-.2) (0,0.3,0)\nspace units: \"cm\" "
                    "\"cm\" \"cm\"\n")));
  check_is_picture(folder.write("c.nrrd", with_spacings("spacings: 1 2e-3 3\nunits: \"mm\" \"m\" \"\"\n")));
  check_is_picture(folder.write("a.mha", with_meta("ElementSpacing = 1000 2000 3000\nDistanceUnits = um\n")));
  check_is_picture(folder.write("b.mha", with_meta("ElementSpacing = .1 .2 .3\nDistanceUnits = cm\n")));
  check_is_picture(folder.write("c.mha", with_meta("ElementSpacing = 1 2 3\nDistanceUnits = ?\n")));
  Labels in_tenths = bone_and_fat(10, folder.write("d.nrrd", nrrd() + picture_bytes));
  in_tenths.scale = 10; // of a file that says it wrongly
  CHECK(make_label_mesh(in_tenths).cells.size() == 9 * 6 * 6);
  CHECK_THAT(refusal(bone_and_fat(1, folder.write("e.nii", Nifti().units(5)))), Contains("xyzt_units 5"));
  CHECK_THAT(refusal(bone_and_fat(
                 1, folder.write("e.nrrd", with_spacings("spacings: 1 2 3\nunits: \"ft\" \"mm\" \"mm\"\n")))),
             Contains("lengths in 'ft', must be nm, um, mm, cm or m"));
  CHECK_THAT(
      refusal(bone_and_fat(1, folder.write("f.nrrd", with_spacings("spacings: 1 2 3\nunits: \"mm\"\n")))),
      Contains("three in quotes"));
}

TEST_CASE("a NIfTI file whose map to the scanner has voxels of another size or sheared ones is refused") {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& content) { return folder.write("a.nii", content); };
  for (const auto code : std::array<std::int16_t, 3>{1, 2, 3}) {
    CHECK_THAT(refusal(bone_and_fat(1, write(Nifti().map(code, 2 * straight)))),
               Contains("1 x 2 x 3 by its pixdim and of 2 x 4 x 6 by its sform"));
    Eigen::Matrix3f sheared = straight;
    sheared(0, 1) = 0.2F;
    CHECK_THAT(refusal(bone_and_fat(1, write(Nifti().map(code, sheared)))), Contains("sheared"));
  }
  const Eigen::Matrix3f turned = Eigen::AngleAxisf(0.3F, Eigen::Vector3f(1, 2, 3).normalized()) * straight;
  check_is_picture(write(Nifti().map(1, turned)));
  check_is_picture(write(Nifti().map(4, 2 * straight, 1))); // an atlas's, beside the scanner's
  check_is_picture(write(Nifti().map(0, 2 * straight)));    // no map
}

TEST_CASE("a size of voxels that is missing, malformed or sheared is refused and not taken for 1") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& content) {
    return refusal(bone_and_fat(1, folder.write(name, content)));
  };
  for (const char* numbers : {"1,5 2 3", "1.5mm 2 3", "1 2", "1 2 3 4", "nan 2 3", "1 inf 3", "1 2 x", ""}) {
    INFO(numbers);
    CHECK_THAT(refused("a.nrrd", with_spacings(std::string("spacings: ") + numbers + "\n")),
               Contains("must be 3 numbers"));
    CHECK_THAT(refused("a.mha", with_meta(std::string("ElementSpacing = ") + numbers + "\n")),
               Contains("must be 3 numbers"));
  }
  for (const char* numbers : {"0 2 3", "-1 2 3"}) {
    CHECK_THAT(refused("a.nrrd", with_spacings(std::string("spacings: ") + numbers + "\n")),
               Contains("must be above 0"));
    CHECK_THAT(refused("a.mha", with_meta(std::string("ElementSpacing = ") + numbers + "\n")),
               Contains("must be above 0"));
  }
  CHECK_THAT(refused("a.nrrd", with_spacings("")), Contains("neither 'spacings' nor 'space directions'"));
  CHECK_THAT(refused("a.nrrd", with_spacings("spacings: 1 2 3\nspace directions: (1,0,0) (0,2,0) (0,0,3)\n")),
             Contains("must have one of them"));
  CHECK_THAT(refused("a.nrrd", with_spacings("space directions: (1,0,0) (0,2,0) none\n")),
             Contains("must be 9 numbers"));
  CHECK_THAT(refused("a.nrrd", with_spacings("space directions: (1,0,0) (0.5,2,0) (0,0,3)\n")),
             Contains("sheared"));
  CHECK_THAT(refused("a.mha", with_meta("")), Contains("without 'elementspacing'"));
  for (const char* key : {"TransformMatrix", "Rotation", "Orientation"}) {
    const std::string spacing = "ElementSpacing = 1 2 3\n" + std::string(key);
    CHECK_THAT(refused("a.mha", with_meta(spacing + " = 1 0 0 0.5 1 0 0 0 1\n")), Contains("sheared"));
    CHECK_THAT(refused("a.mha", with_meta(spacing + " = 2 0 0 0 1 0 0 0 1\n")), Contains("no rotation"));
    check_is_picture(folder.write("b.mha", with_meta(spacing + " = 0 1 0 -1 0 0 0 0 1\n")));
  }
  const std::string list = case_text::replaced(plist(), "<real>1</real>", "<real>1,5</real>");
  CHECK_THAT(refused("a.inv3", project(list, picture_bytes)), Contains("spacing '1,5', must be a number"));
}

TEST_CASE("a NRRD with more voxels than it says is refused, wherever they are") {
  const TemporaryFolder folder;
  folder.write("c.raw", picture_bytes + "xx");
  CHECK_THAT(refusal(bone_and_fat(1, folder.write("c.nhdr", nrrd("data file: c.raw\n")))),
             Contains("has 146 bytes of voxels, must have 144"));
  CHECK_THAT(refusal(bone_and_fat(1, folder.write("d.nrrd", nrrd() + picture_bytes + "xx"))),
             Contains("must have 144"));
  CHECK_THAT(refusal(bone_and_fat(1, folder.write("c.nhdr", nrrd("byte skip: 2\ndata file: c.raw\n")))),
             Contains("byte skip '2', must be 0"));
}
