#include "cases/mesh/vtk_functions.hpp"

#include "tests/support/case_text.hpp"
#include "tests/support/pictures.hpp"

#include <Eigen/Geometry>
#include <zlib.h>

using namespace springproof;

using namespace cases;
using namespace pictures;
using Catch::Contains;

// Units and sheared voxels were looked for in InVesalius's main.plist (mm, three numbers, no unit), images of
// VTK (.vti, whose direction is read: foreign_files_test.cpp), STL and gmsh (no units: body.scale), and
// intensities' slopes (labels_test.cpp).

namespace {

const std::string picture_bytes = bytes_of_picture<std::int16_t>();

std::string packed(const std::string& bytes) {
  z_stream stream{};
  constexpr int memory = 8, of_gzip = 15 + 16;
  REQUIRE(deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, of_gzip, memory, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string content = bytes, result(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(content.data());
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

/// Name and content of the picture in every format that can be compressed.
std::vector<std::pair<std::string, std::string>> compressed(const std::string& voxels) {
  return {{"a.nii.gz", packed(nifti({12, 3, 2}) + voxels)}, {"a.inv3", packed(project(plist(), voxels))}};
}

const Eigen::Matrix3f straight = Eigen::Vector3f(1, 2, 3).asDiagonal();

} // namespace

TEST_CASE("compressed pictures become the same cells, and what follows the end is nobody's") {
  const TemporaryFolder folder;
  for (const auto& [name, content] : compressed(picture_bytes)) {
    CAPTURE(name);
    check_is_picture(folder.write(name, content));
    check_is_picture(folder.write(name, content + std::string(100, '\0')));
  }
}

TEST_CASE("a compressed picture with a byte that its checksum refutes or without an end is refused") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& content) {
    return refusal(bone_and_fat(1, folder.write(name, content)));
  };
  for (const auto& [name, content] : compressed(picture_bytes)) {
    CAPTURE(name);
    for (const std::size_t from_end : {1, 6}) { // a byte of the length, one of the checksum
      std::string damaged = content;
      damaged[damaged.size() - from_end] ^= 1;
      CHECK_THAT(refused(name, damaged), Contains("is damaged where it is compressed") ||
                                             Contains("Bad NIfTI header")); // VTK reads it at once
    }
    for (std::size_t less = 1; less < content.size(); less += 7) { // or what is left is no header
      const std::string refusal = refused(name, content.substr(0, content.size() - less));
      CHECK_THAT(refusal, less < 10 ? Contains("is cut short") : Contains(name));
    }
  }
  const auto [name, fewer] = compressed(picture_bytes.substr(0, 100))[0];
  CHECK_THAT(refused(name, fewer), Contains("is cut short: holds"));
}

TEST_CASE("what inflates to far more than its header says is refused before it is read") {
  const TemporaryFolder folder;
  const auto [name, bomb] = compressed(picture_bytes + std::string(100'000'000, '\0'))[0];
  CHECK(bomb.size() < 200'000);
  CHECK_THAT(refusal(bone_and_fat(1, folder.write(name, bomb))), Contains("far more than its header"));
}

TEST_CASE("a NIfTI file whose first number is no size of a header is none") {
  const TemporaryFolder folder;
  for (const char* name : {"a.nii", "a.nii.gz"}) {
    std::string content = nifti({12, 3, 2}) + picture_bytes;
    content[0] = content[1] = 0;
    const bool is_packed = std::string(name) == "a.nii.gz";
    CHECK_THAT(refusal(bone_and_fat(1, folder.write(name, is_packed ? packed(content) : content))),
               Contains("neither 348 nor 540"));
  }
}

TEST_CASE("a picture whose file says another unit than mm is the same body", "[verification]") {
  const TemporaryFolder folder;
  check_is_picture(folder.write("a.nii", Nifti().lengths(1e-3).units(1)));     // metres
  check_is_picture(folder.write("b.nii", Nifti().lengths(1e3).units(3 | 16))); // micrometres and ms
  check_is_picture(folder.write("c.nii", Nifti().units(2)));
  check_is_picture(folder.write("d.nii", Nifti().units(8))); // none of length: mm
  Labels in_tenths = bone_and_fat(10, folder.write("e.nii", Nifti()));
  in_tenths.scale = 10; // overrides a unit that the file states wrongly
  CHECK(make_label_mesh(in_tenths).cells.size() == 9 * 6 * 6);
  CHECK_THAT(refusal(bone_and_fat(1, folder.write("e.nii", Nifti().units(5)))), Contains("xyzt_units 5"));
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

TEST_CASE("a size of voxels that is no number is refused and not taken for 1") {
  const TemporaryFolder folder;
  const std::string list = case_text::replaced(plist(), "<real>1</real>", "<real>1,5</real>");
  CHECK_THAT(refusal(bone_and_fat(1, folder.write("a.inv3", project(list, picture_bytes)))),
             Contains("spacing '1,5', must be a number"));
}
