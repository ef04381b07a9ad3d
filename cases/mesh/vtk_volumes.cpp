#include "cases/case/input_file.hpp"
#include "cases/mesh/vtk_parts.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <archive.h>
#include <archive_entry.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <sstream>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>
#include <zlib.h>

namespace springproof::cases {

namespace {

/// Tolerance on two statements of a length, relative, and on right angles: half a voxel in 500.
constexpr double voxel_tolerance = 1e-3;

/// The edges of a voxel from the steps between voxels.
/// @param steps  one along each axis of the array, in columns
/// @throws std::runtime_error unless they are at right angles
Eigen::Vector3d edges_of_voxel(const Eigen::Matrix3d& steps) {
  const Eigen::Vector3d edges = steps.colwise().norm();
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    if (!(std::abs(steps.col(a).dot(steps.col(b))) <= voxel_tolerance * edges[a] * edges[b]))
      refuse("has sheared voxels: the axes of its array must be at right angles to each other; resample it");
  }
  return edges;
}

std::string shown(const Eigen::Vector3d& edges) {
  std::ostringstream text;
  text << edges.x() << " x " << edges.y() << " x " << edges.z();
  return text.str();
}

/// @return mm
double unit_of_length(vtkNIFTIImageHeader& header) {
  constexpr std::array<double, 4> units{1, 1e3, 1, 1e-3}; // none, m, mm, um
  const auto unit = static_cast<std::size_t>(header.GetXYZTUnits() & 7);
  if (unit < units.size()) return units[unit];
  refuse("has lengths in 'xyzt_units " + std::to_string(unit) + "', must be um, mm or m");
}

/// A map from the numbers (i, j, k) of a voxel to its centre in the world, in the file's unit of length.
using VoxelMap = Eigen::Matrix<double, 3, 4>;

/// NIfTI's method 3.
VoxelMap sform_of(vtkNIFTIImageHeader& header) {
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> map;
  header.GetSRowX(map.row(0).data());
  header.GetSRowY(map.row(1).data());
  header.GetSRowZ(map.row(2).data());
  return map;
}

/// NIfTI's method 2: a quaternion, whose real part is not in the file, spacings, and qfac in pixdim[0].
VoxelMap qform_of(vtkNIFTIImageHeader& header, const Eigen::Vector3d& edges) {
  const Eigen::Vector3d part(header.GetQuaternB(), header.GetQuaternC(), header.GetQuaternD());
  const double real_squared = 1 - part.squaredNorm();
  constexpr double rounding = 1e-6, // in single precision
      half_turn = 1e-7;             // NIfTI's own bound: the real part is then 0
  if (!(real_squared >= -rounding))
    refuse("has quatern_b, quatern_c, quatern_d of more than unit length, which are no rotation");
  const Eigen::Quaterniond turn(real_squared < half_turn ? 0 : std::sqrt(real_squared), part.x(), part.y(),
                                part.z());
  VoxelMap map;
  map.leftCols<3>() = turn.normalized().toRotationMatrix() * edges.asDiagonal();
  map.col(3) = Eigen::Vector3d(header.GetQOffsetX(), header.GetQOffsetY(), header.GetQOffsetZ());
  if (header.GetPixDim(0) < 0) map.col(2) *= -1;
  return map;
}

/// Whether the sform leads to where the scanner or an aligned picture has the voxels. One to an atlas (codes
/// 3 and up) gives way to a qform.
bool has_sform(vtkNIFTIImageHeader& header) {
  constexpr int of_atlas = 3;
  return header.GetSFormCode() > 0 && !(header.GetSFormCode() >= of_atlas && header.GetQFormCode() > 0);
}

/// The grid spacings of pixdim, with which the sform must agree.
Eigen::Vector3d voxel_of(vtkNIFTIImageReader& reader) {
  vtkNIFTIImageHeader& header = *reader.GetNIFTIHeader();
  const Eigen::Vector3d edges(reader.GetDataSpacing());
  if (has_sform(header)) {
    const Eigen::Vector3d by_map = edges_of_voxel(sform_of(header).leftCols<3>());
    if (!((by_map - edges).array().abs() <= voxel_tolerance * edges.array()).all())
      refuse("says voxels of " + shown(edges) + " by its pixdim and of " + shown(by_map) +
             " by its sform, which must agree: set the one that is wrong");
  }
  return edges * unit_of_length(header);
}

/// The rotation nearest to steps at right angles. It is exact where they lie along axes of the world to the
/// rounding of single precision.
/// @throws std::runtime_error if they are left-handed
Eigen::Matrix3d rotation_of(const Eigen::Matrix3d& steps) {
  if (!(steps.determinant() > 0))
    refuse(
        "has a sform that mirrors the array, beside a qform that does not, or numbers in them that are none: "
        "set the code of the one that is wrong to 0");
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(steps.colwise().normalized(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = parts.matrixU() * parts.matrixV().transpose();
  const Eigen::Matrix3d along_axes = rotation.array().round();
  constexpr double rounding = 1e-6;
  return rotation.isApprox(along_axes, rounding) ? along_axes : rotation;
}

/// The first number of a header, in either order of bytes, says which it is; VTK does not look at it.
void check_size_of_header(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"),
                                                        gzclose); // plain ones too
  std::array<unsigned char, 4> bytes{};
  const bool is_read = file && gzread(file.get(), bytes.data(), bytes.size()) == 4;
  const auto number = [&](auto begin) {
    return begin[0] + 256 * (begin[1] + 256 * (begin[2] + 256L * begin[3]));
  };
  for (const long size : {348L, 540L}) // NIfTI-1's and NIfTI-2's
    if (is_read && (number(bytes.begin()) == size || number(bytes.rbegin()) == size)) return;
  refuse("is no NIfTI file: its first number, the size of its header, is neither 348 nor 540");
}

/// Checks what VTK does not: it takes other magic words for older formats, and what is no length for 1 mm.
void check_header(vtkNIFTIImageReader& reader, const std::string& path) {
  check_size_of_header(path);
  vtkNIFTIImageHeader& header = *reader.GetNIFTIHeader();
  const std::string magic = header.GetMagic() == nullptr ? "" : header.GetMagic();
  if (magic.rfind("n+1", 0) != 0 && magic.rfind("n+2", 0) != 0)
    refuse("is no NIfTI file with its voxels: its magic word is neither n+1 nor n+2");
  for (int a = 1; a <= std::min<std::int64_t>(3, header.GetDim(0)); ++a)
    if (const double length = header.GetPixDim(a); !(length > 0))
      refuse("has voxels of " + std::to_string(length) + " mm, must be above 0 mm");
  const int bits =
      8 * vtkDataArray::GetDataTypeSize(reader.GetDataScalarType()) * reader.GetNumberOfScalarComponents();
  if (header.GetBitPix() != bits)
    refuse("says " + std::to_string(header.GetBitPix()) + " bits a voxel, its type has " +
           std::to_string(bits));
  if (!std::isfinite(reader.GetRescaleSlope()) || !std::isfinite(reader.GetRescaleIntercept()))
    refuse("has a scale of its intensities that is no number");
}

/// @param most_bytes  most bytes of voxels that the file can hold
/// @throws std::runtime_error unless there are voxels of a finite size above 0, no more than the file can
/// hold, and so few that they can be numbered
/// @return how many there are
std::size_t checked_voxels(const std::array<int, 3>& voxels, const Eigen::Vector3d& spacing,
                           std::size_t bytes_a_voxel, std::uint64_t most_bytes) {
  const std::string size =
      std::to_string(voxels[0]) + " x " + std::to_string(voxels[1]) + " x " + std::to_string(voxels[2]);
  double n = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (voxels[a] < 1) refuse("has " + size + " voxels, must have some in every direction");
    n *= voxels[a];
    const double length = spacing[static_cast<int>(a)];
    if (!(length > 1e-6 && length < 1e6))
      refuse("has voxels of " + std::to_string(length) + " mm, must be from 1e-6 to 1e6 mm");
  }
  if (!(n * static_cast<double>(bytes_a_voxel) <= static_cast<double>(most_bytes)))
    refuse("says that it has " + size + " voxels, more than the file can hold");
  if (!(n <= std::numeric_limits<int>::max())) refuse("has " + size + " voxels, must have fewer than 2^31");
  return static_cast<std::size_t>(n);
}

/// Inflates a gzipped file piece by piece, and keeps none: readers believe bytes that a checksum refutes, and
/// what has no end.
/// @param least, most  how many bytes it may hold
/// @throws std::runtime_error unless it is whole, its checksums right, and holds as many
void check_gzip(const std::string& path, std::uint64_t least, std::uint64_t most) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) refuse("cannot be read");
  std::array<char, 1 << 16> piece;
  std::uint64_t held = 0;
  for (int n = 1; (n = gzread(file.get(), piece.data(), piece.size())) > 0;) {
    held += static_cast<std::uint64_t>(n);
    if (held > most)
      refuse("holds more than " + std::to_string(most) +
             " bytes where it is compressed, far more than its header says");
  }
  int status = Z_OK;
  const std::string message = gzerror(file.get(), &status); // "PATH: reason"
  if (status == Z_BUF_ERROR) refuse("is cut short: what is compressed has no end");
  if (status != Z_OK || gzdirect(file.get()) != 0)
    refuse("is damaged where it is compressed: " +
           (status == Z_OK ? "incorrect header check" : message.substr(path.size() + 2)));
  if (held < least)
    refuse("is cut short: holds " + std::to_string(held) + " bytes where it is compressed, its header says " +
           std::to_string(least));
}

/// Checks the size of a compressed file: it may hold its header, as many voxels as that says, and further
/// pictures that follow in time and are not read.
void check_compressed(const std::string& path, vtkNIFTIImageHeader& header, const VolumeBytes& bytes,
                      std::uint64_t of_voxels) {
  const std::uint64_t least =
      of_voxels + static_cast<std::uint64_t>(std::clamp<std::int64_t>(header.GetVoxOffset(), 0, 1 << 30));
  double n_pictures = 1;
  for (int a = 4; a <= std::min<std::int64_t>(7, header.GetDim(0)); ++a)
    n_pictures *= std::clamp<double>(static_cast<double>(header.GetDim(a)), 1, 1e6);
  constexpr double room = 1 << 20; // for what may follow
  const double most =
      std::min(room + n_pictures * static_cast<double>(least), static_cast<double>(bytes.of_voxels));
  check_gzip(path, least, static_cast<std::uint64_t>(most));
}

/// Shortens VTK's messages, which name the file, objects and addresses, in several lines.
std::string in_one_line(std::string message, const std::string& path) {
  if (message.find("returned failure for request") != std::string::npos)
    return "is damaged or no such file, says VTK";
  if (const std::size_t at = message.find(path); at != std::string::npos) message.erase(at, path.size());
  return "VTK: " + message.substr(0, message.find('\n'));
}

/// Runs an action on a file, and throws VTK's errors in one line.
template<class Action>
void run_on(const std::string& path, const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    refuse(in_one_line(error.what(), path));
  }
}

/// Opens a NIfTI file, and reads and checks what it says about its voxels.
void read_header(vtkNIFTIImageReader& reader, const std::string& path) {
  reader.SetFileName(path.c_str());
  run_on(path, [&] { run_information(reader); });
  if (const int n = reader.GetNumberOfScalarComponents(); n != 1)
    refuse("has " + std::to_string(n) + " numbers a voxel, must have one");
  check_header(reader, path);
}

constexpr std::uint64_t most_bytes_of_list = 1'000'000, most_bytes_of_project = 20'000'000'000;

/// The content of the first file of a gzipped tar that has a name in its folder.
/// @param what  what it is, for messages   @param least, most  how many bytes it may have
std::string unpacked(const std::string& path, const std::string& what, const std::string& wanted,
                     std::uint64_t least, std::uint64_t most) {
  const std::unique_ptr<archive, int (*)(archive*)> reader(archive_read_new(), archive_read_free);
  archive_read_support_filter_gzip(reader.get());
  archive_read_support_format_tar(reader.get());
  const auto check = [&](long long status) {
    if (status >= ARCHIVE_WARN) return;
    const char* reason = archive_error_string(reader.get());
    refuse(std::string("is no gzipped tar: ") + (reason == nullptr ? "damaged" : reason));
  };
  check(archive_read_open_filename(reader.get(), path.c_str(), 1 << 16));
  for (archive_entry* entry = nullptr;;) {
    const int status = archive_read_next_header(reader.get(), &entry);
    if (status == ARCHIVE_EOF) refuse("has no " + what);
    check(status);
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr || std::filesystem::path(name).filename() != wanted) continue;
    const la_int64_t size = archive_entry_size(entry);
    const auto n_bytes = static_cast<std::uint64_t>(size);
    if (size < 0 || n_bytes < least || n_bytes > most)
      refuse(what + " has " + std::to_string(size) + " bytes, which cannot be");
    std::string content(n_bytes, '\0');
    const la_ssize_t n = archive_read_data(reader.get(), content.data(), content.size());
    check(n);
    if (n != size) refuse(what + " is cut short");
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
  refuse("main.plist has no " + key);
}

std::string text_of(vtkXMLDataElement& element, const std::string& key) {
  if (element.GetCharacterData() == nullptr) refuse("main.plist has no value of " + key);
  return element.GetCharacterData();
}

/// The three numbers of an array.
std::array<double, 3> numbers_of(vtkXMLDataElement& dictionary, const std::string& key) {
  vtkXMLDataElement& list = value_of_key(dictionary, key);
  if (list.GetNumberOfNestedElements() != 3) refuse("main.plist has no three numbers of " + key);
  std::array<double, 3> numbers{};
  for (int i = 0; i < 3; ++i) {
    const std::string text = text_of(*list.GetNestedElement(i), key);
    const auto number = number_in<double>(text);
    if (!number) refuse("main.plist says " + key + " '" + text.substr(0, 100) + "', must be a number");
    numbers[static_cast<std::size_t>(i)] = *number;
  }
  return numbers;
}

/// Reads a project of InVesalius: a gzipped tar whose main.plist names the file of the voxels, int16, least
/// byte first, its shape (z, y, x) and the spacing (x, y, z).
/// @throws std::runtime_error if it is none
Volume read_inv3(const std::string& path, const VolumeBytes& bytes) {
  // Masks and surfaces beside the voxels may take more than these.
  if (bytes.is_compressed) check_gzip(path, 0, most_bytes_of_project);
  const std::string list = unpacked(path, "main.plist", "main.plist", 0, most_bytes_of_list);
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromString(list.c_str()));
  if (!root || root->GetNumberOfNestedElements() < 1) refuse("main.plist is no property list");
  vtkXMLDataElement& project = *root->GetNestedElement(0);
  vtkXMLDataElement& matrix = value_of_key(project, "matrix");
  if (const std::string type = text_of(value_of_key(matrix, "dtype"), "dtype"); type != "int16")
    refuse("main.plist says dtype '" + type + "', must be int16");
  const std::array<double, 3> shape = numbers_of(matrix, "shape"), spacing = numbers_of(project, "spacing");
  Volume volume;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(shape[a] >= 1 && shape[a] < 1e6)) refuse("main.plist says a shape that is none");
    volume.voxels[2 - a] = static_cast<int>(shape[a]);
  }
  volume.spacing = Eigen::Vector3d(spacing.data());
  const std::size_t n = checked_voxels(volume.voxels, volume.spacing, sizeof(std::int16_t), bytes.of_voxels);
  const std::string file = text_of(value_of_key(matrix, "filename"), "filename");
  const std::size_t n_bytes = n * sizeof(std::int16_t);
  const std::string voxels = unpacked(path, "file of voxels", file, n_bytes, n_bytes);
  std::vector<std::int16_t> numbers(n);
  std::memcpy(numbers.data(), voxels.data(), voxels.size());
  volume.intensities.assign(numbers.begin(), numbers.end());
  return volume;
}

} // namespace

Placement read_placement(const std::string& path) {
  const vtkNew<vtkNIFTIImageReader> reader;
  read_header(*reader, path);
  vtkNIFTIImageHeader& header = *reader->GetNIFTIHeader();
  Placement placement;
  placement.is_by_sform = has_sform(header);
  placement.code = placement.is_by_sform ? header.GetSFormCode() : header.GetQFormCode();
  if (placement.code <= 0)
    refuse("has no world coordinates, its sform_code and qform_code are 0: leave frame out");
  const Eigen::Vector3d voxel = voxel_of(*reader);
  VoxelMap map =
      placement.is_by_sform ? sform_of(header) : qform_of(header, Eigen::Vector3d(reader->GetDataSpacing()));
  if (reader->GetQFac() < 0) { // VTK reads slices in reverse order, so that the array is right-handed
    map.col(3) += map.col(2) * (reader->GetDataExtent()[5] - reader->GetDataExtent()[4]);
    map.col(2) *= -1;
  }
  const Eigen::Matrix3d rotation = rotation_of(map.leftCols<3>());
  for (std::size_t a = 0; a < 3; ++a) placement.axes[a] = rotation.col(static_cast<int>(a));
  placement.corner = unit_of_length(header) * map.col(3) - rotation * (voxel / 2);
  return placement;
}

Volume read_volume(const std::string& path, const VolumeBytes& bytes) {
  if (std::filesystem::path(path).extension() == ".inv3") return read_inv3(path, bytes);
  const vtkNew<vtkNIFTIImageReader> reader;
  read_header(*reader, path);
  Volume volume;
  const int* extent = reader->GetDataExtent();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n = static_cast<std::int64_t>(extent[2 * a + 1]) - extent[2 * a] + 1;
    volume.voxels[a] = n > 0 && n < std::numeric_limits<int>::max() ? static_cast<int>(n) : 0;
  }
  volume.spacing = voxel_of(*reader);
  const int bytes_a_voxel = vtkDataArray::GetDataTypeSize(reader->GetDataScalarType());
  if (bytes_a_voxel < 1) refuse("has voxels of no type of numbers");
  const std::size_t n =
      checked_voxels(volume.voxels, volume.spacing, static_cast<std::size_t>(bytes_a_voxel), bytes.of_voxels);
  if (bytes.is_compressed)
    check_compressed(path, *reader->GetNIFTIHeader(), bytes, n * static_cast<std::size_t>(bytes_a_voxel));
  run_on(path, [&] { run(*reader); });
  vtkDataArray* numbers = reader->GetOutput()->GetPointData()->GetScalars();
  if (numbers == nullptr || static_cast<std::size_t>(numbers->GetNumberOfValues()) != n)
    refuse("has other voxels than it says");
  const double slope = reader->GetRescaleSlope(), intercept = reader->GetRescaleIntercept();
  volume.intensities.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    const double number = numbers->GetComponent(static_cast<vtkIdType>(v), 0);
    volume.intensities[v] = static_cast<float>(slope != 0 ? slope * number + intercept : number);
  }
  return volume;
}

} // namespace springproof::cases
