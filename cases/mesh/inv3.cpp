#include "cases/case/input_file.hpp"
#include "cases/mesh/vtk_parts.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

namespace springproof::cases {

namespace {

constexpr std::uint64_t most_bytes_of_list = 1'000'000, most_bytes_of_project = 20'000'000'000;

[[noreturn]] void refuse_archive(const std::string& reason) {
  throw std::runtime_error(reason);
}

/// The content of the first file of a gzipped tar for which `is_wanted(name in its folder)`.
/// @param is_allowed  whether it may have a size in bytes
template<class IsWanted, class IsAllowed>
std::string unpacked(const std::string& path, const std::string& what, const IsWanted& is_wanted,
                     const IsAllowed& is_allowed) {
  const std::unique_ptr<archive, int (*)(archive*)> reader(archive_read_new(), archive_read_free);
  archive_read_support_filter_gzip(reader.get());
  archive_read_support_format_tar(reader.get());
  const auto check = [&](long long status) {
    if (status >= ARCHIVE_WARN) return;
    const char* reason = archive_error_string(reader.get());
    refuse_archive(std::string("is no gzipped tar: ") + (reason == nullptr ? "damaged" : reason));
  };
  check(archive_read_open_filename(reader.get(), path.c_str(), 1 << 16));
  for (archive_entry* entry = nullptr;;) {
    const int status = archive_read_next_header(reader.get(), &entry);
    if (status == ARCHIVE_EOF) refuse_archive("has no " + what);
    check(status);
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr || !is_wanted(std::filesystem::path(name).filename().string())) continue;
    const la_int64_t size = archive_entry_size(entry);
    if (size < 0 || !is_allowed(static_cast<std::uint64_t>(size)))
      refuse_archive(what + " has " + std::to_string(size) + " bytes, which cannot be");
    std::string content(static_cast<std::size_t>(size), '\0');
    const la_ssize_t n = archive_read_data(reader.get(), content.data(), content.size());
    check(n);
    if (n != size) refuse_archive(what + " is cut short");
    return content;
  }
}

/// The value of a key of a property list's dictionary.
vtkXMLDataElement& value_of_key(vtkXMLDataElement& dictionary, const std::string& key) {
  const auto is_key = [&](vtkXMLDataElement* element) {
    return std::strcmp(element->GetName(), "key") == 0 && element->GetCharacterData() != nullptr &&
           key == element->GetCharacterData();
  };
  for (int i = 0; i + 1 < dictionary.GetNumberOfNestedElements(); ++i)
    if (is_key(dictionary.GetNestedElement(i))) return *dictionary.GetNestedElement(i + 1);
  refuse_archive("main.plist has no " + key);
}

std::string text_of(vtkXMLDataElement& element, const std::string& key) {
  if (element.GetCharacterData() == nullptr) refuse_archive("main.plist has no value of " + key);
  return element.GetCharacterData();
}

/// The three numbers of an array.
std::array<double, 3> numbers_of(vtkXMLDataElement& dictionary, const std::string& key) {
  vtkXMLDataElement& list = value_of_key(dictionary, key);
  if (list.GetNumberOfNestedElements() != 3) refuse_archive("main.plist has no three numbers of " + key);
  std::array<double, 3> numbers{};
  for (int i = 0; i < 3; ++i) {
    const std::string text = text_of(*list.GetNestedElement(i), key);
    const auto number = number_in<double>(text);
    if (!number)
      refuse_archive("main.plist says " + key + " '" + text.substr(0, 100) + "', must be a number");
    numbers[static_cast<std::size_t>(i)] = *number;
  }
  return numbers;
}

} // namespace

Volume read_inv3(const std::string& path, const VolumeBytes& bytes) {
  // Masks and surfaces beside the voxels may take more than these.
  if (bytes.is_compressed) check_gzip(path, 0, most_bytes_of_project);
  const std::string list = unpacked(
      path, "main.plist", [](const std::string& name) { return name == "main.plist"; },
      [](std::uint64_t size) { return size <= most_bytes_of_list; });
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromString(list.c_str()));
  if (!root || root->GetNumberOfNestedElements() < 1) refuse_archive("main.plist is no property list");
  vtkXMLDataElement& project = *root->GetNestedElement(0);
  vtkXMLDataElement& matrix = value_of_key(project, "matrix");
  if (const std::string type = text_of(value_of_key(matrix, "dtype"), "dtype"); type != "int16")
    refuse_archive("main.plist says dtype '" + type + "', must be int16");
  const std::array<double, 3> shape = numbers_of(matrix, "shape"), spacing = numbers_of(project, "spacing");
  Volume volume;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(shape[a] >= 1 && shape[a] < 1e6)) refuse_archive("main.plist says a shape that is none");
    volume.voxels[2 - a] = static_cast<int>(shape[a]);
  }
  volume.spacing = Eigen::Vector3d(spacing.data());
  const std::size_t n = checked_voxels(volume.voxels, volume.spacing, sizeof(std::int16_t), bytes.of_voxels);
  const std::string file = text_of(value_of_key(matrix, "filename"), "filename");
  const std::string voxels = unpacked(
      path, "file of voxels", [&](const std::string& name) { return name == file; },
      [&](std::uint64_t size) { return size == n * sizeof(std::int16_t); });
  std::vector<std::int16_t> numbers(n);
  std::memcpy(numbers.data(), voxels.data(), voxels.size());
  volume.intensities.assign(numbers.begin(), numbers.end());
  return volume;
}

} // namespace springproof::cases
