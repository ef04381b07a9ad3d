#include "tests/support/case_text.hpp"
#include "tests/support/pictures.hpp"

#include <zlib.h>

using namespace springproof;

using namespace cases;
using namespace pictures;
using Catch::Contains;

namespace {

enum class Format { zlib = 15, gzip = 15 + 16 };

std::string packed(const std::string& bytes, Format format) {
  z_stream stream{};
  constexpr int memory = 8;
  REQUIRE(deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, static_cast<int>(format), memory,
                       Z_DEFAULT_STRATEGY) == Z_OK);
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

/// What stands before compressed voxels, and the voxels.
struct Compressed {
  std::string name, header, voxels;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// The picture of every format that can be compressed.
std::vector<Compressed> compressed(const std::string& voxels) {
  const std::string in_zlib = packed(voxels, Format::zlib);
  return {{"a.nii.gz", "", packed(nifti({12, 3, 2}) + voxels, Format::gzip)},
          {"a.nrrd", replaced(nrrd(), "raw", "gzip"), packed(voxels, Format::gzip)},
          {"a.mha",
           replaced(meta("LOCAL"), "NDims",
                    fmt::format("CompressedData = True\nCompressedDataSize = {}\nNDims", in_zlib.size())),
           in_zlib},
          {"a.inv3", "", packed(project(plist(), voxels), Format::gzip)}};
}

} // namespace

TEST_CASE("compressed pictures become the same cells, and what follows the end is nobody's") {
  const TemporaryFolder folder;
  for (const auto& [name, header, voxels] : compressed(bytes_of_picture<std::int16_t>())) {
    CAPTURE(name);
    check_is_picture(folder.write(name, header + voxels));
    check_is_picture(folder.write(name, header + voxels + std::string(100, '\0')));
  }
}

TEST_CASE("a compressed picture with a byte that its checksum refutes or without an end is refused") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& content) {
    return refusal(bone_and_fat(1, folder.write(name, content)));
  };
  for (const auto& [name, header, voxels] : compressed(bytes_of_picture<std::int16_t>())) {
    CAPTURE(name);
    for (const std::size_t from_end :
         {1, 6}) { // in gzip of the length and the checksum, in zlib of that and data
      std::string damaged = header + voxels;
      damaged[damaged.size() - from_end] ^= 1;
      CHECK_THAT(refused(name, damaged), Contains("is damaged where it is compressed") ||
                                             Contains("Bad NIfTI header")); // VTK reads it at once
    }
    for (std::size_t less = 1; less < voxels.size(); less += 7) { // or what is left is no header
      const std::string refusal = refused(name, header + voxels.substr(0, voxels.size() - less));
      CHECK_THAT(refusal, less < 10 ? Contains("is cut short") : Contains(name));
    }
  }
  const std::string voxels = bytes_of_picture<std::int16_t>();
  for (const auto& [name, header, fewer] : compressed(voxels.substr(0, 100))) {
    if (name == "a.inv3") continue; // whose member has a size of its own
    CAPTURE(name);
    CHECK_THAT(refused(name, header + fewer), Contains("is cut short: holds"));
  }
}

TEST_CASE("a compressed NRRD with more voxels than it says is refused") {
  const TemporaryFolder folder;
  const auto [name, header, more] = compressed(bytes_of_picture<std::int16_t>() + "xx")[1];
  CHECK(name == "a.nrrd");
  CHECK_THAT(refusal(bone_and_fat(1, folder.write(name, header + more))), Contains("more than"));
}

TEST_CASE("what inflates to far more than its header says is refused before it is read") {
  const TemporaryFolder folder;
  const std::string voxels = bytes_of_picture<std::int16_t>() + std::string(100'000'000, '\0');
  for (const auto& [name, header, bomb] : compressed(voxels)) {
    if (name == "a.inv3") continue;
    CAPTURE(name);
    CHECK(bomb.size() < 200'000);
    CHECK_THAT(refusal(bone_and_fat(1, folder.write(name, header + bomb))),
               Contains("far more than its header"));
  }
}

TEST_CASE("a NIfTI file whose first number is no size of a header is none") {
  const TemporaryFolder folder;
  for (const char* name : {"a.nii", "a.nii.gz"}) {
    std::string content = nifti({12, 3, 2}) + bytes_of_picture<std::int16_t>();
    content[0] = content[1] = 0;
    const bool is_packed = std::string(name) == "a.nii.gz";
    CHECK_THAT(
        refusal(bone_and_fat(1, folder.write(name, is_packed ? packed(content, Format::gzip) : content))),
        Contains("neither 348 nor 540"));
  }
}
