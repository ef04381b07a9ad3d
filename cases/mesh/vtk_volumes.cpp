#include "cases/mesh/vtk_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
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
      throw std::runtime_error(
          "has sheared voxels: the axes of its array must be at right angles to each other; resample it");
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
  throw std::runtime_error("has lengths in 'xyzt_units " + std::to_string(unit) + "', must be um, mm or m");
}

/// The grid spacings of pixdim. The affine map of an sform leads to where the scanner or an aligned picture
/// has the voxels, and must agree; one to an atlas (codes 3 and up) need not where a qform leads to the
/// scanner.
Eigen::Vector3d voxel_of(vtkNIFTIImageReader& reader) {
  vtkNIFTIImageHeader& header = *reader.GetNIFTIHeader();
  const Eigen::Vector3d edges(reader.GetDataSpacing());
  constexpr int of_atlas = 3;
  if (header.GetSFormCode() > 0 && !(header.GetSFormCode() >= of_atlas && header.GetQFormCode() > 0)) {
    Eigen::Matrix3d steps;
    double rows[3][4];
    header.GetSRowX(rows[0]);
    header.GetSRowY(rows[1]);
    header.GetSRowZ(rows[2]);
    for (int row = 0; row < 3; ++row)
      for (int a = 0; a < 3; ++a) steps(row, a) = rows[row][a];
    const Eigen::Vector3d by_map = edges_of_voxel(steps);
    if (!((by_map - edges).array().abs() <= voxel_tolerance * edges.array()).all())
      throw std::runtime_error("says voxels of " + shown(edges) + " by its pixdim and of " + shown(by_map) +
                               " by its sform, which must agree: set the one that is wrong");
  }
  return edges * unit_of_length(header);
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
  throw std::runtime_error(
      "is no NIfTI file: its first number, the size of its header, is neither 348 nor 540");
}

/// Checks what VTK does not: it takes other magic words for older formats, and what is no length for 1 mm.
void check_header(vtkNIFTIImageReader& reader, const std::string& path) {
  check_size_of_header(path);
  vtkNIFTIImageHeader& header = *reader.GetNIFTIHeader();
  const std::string magic = header.GetMagic() == nullptr ? "" : header.GetMagic();
  if (magic.rfind("n+1", 0) != 0 && magic.rfind("n+2", 0) != 0)
    throw std::runtime_error("is no NIfTI file with its voxels: its magic word is neither n+1 nor n+2");
  for (int a = 1; a <= std::min<std::int64_t>(3, header.GetDim(0)); ++a)
    if (const double length = header.GetPixDim(a); !(length > 0))
      throw std::runtime_error("has voxels of " + std::to_string(length) + " mm, must be above 0 mm");
  const int bits =
      8 * vtkDataArray::GetDataTypeSize(reader.GetDataScalarType()) * reader.GetNumberOfScalarComponents();
  if (header.GetBitPix() != bits)
    throw std::runtime_error("says " + std::to_string(header.GetBitPix()) + " bits a voxel, its type has " +
                             std::to_string(bits));
  if (!std::isfinite(reader.GetRescaleSlope()) || !std::isfinite(reader.GetRescaleIntercept()))
    throw std::runtime_error("has a scale of its intensities that is no number");
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
    throw std::runtime_error(in_one_line(error.what(), path));
  }
}

} // namespace

std::size_t checked_voxels(const std::array<int, 3>& voxels, const Eigen::Vector3d& spacing,
                           std::size_t bytes_a_voxel, std::uint64_t most_bytes) {
  const std::string size =
      std::to_string(voxels[0]) + " x " + std::to_string(voxels[1]) + " x " + std::to_string(voxels[2]);
  double n = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (voxels[a] < 1) throw std::runtime_error("has " + size + " voxels, must have some in every direction");
    n *= voxels[a];
    const double length = spacing[static_cast<int>(a)];
    if (!(length > 1e-6 && length < 1e6))
      throw std::runtime_error("has voxels of " + std::to_string(length) +
                               " mm, must be from 1e-6 to 1e6 mm");
  }
  if (!(n * static_cast<double>(bytes_a_voxel) <= static_cast<double>(most_bytes)))
    throw std::runtime_error("says that it has " + size + " voxels, more than the file can hold");
  if (!(n <= std::numeric_limits<int>::max()))
    throw std::runtime_error("has " + size + " voxels, must have fewer than 2^31");
  return static_cast<std::size_t>(n);
}

void check_gzip(const std::string& path, std::uint64_t least, std::uint64_t most) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw std::runtime_error("cannot be read");
  std::array<char, 1 << 16> piece;
  std::uint64_t held = 0;
  for (int n = 1; (n = gzread(file.get(), piece.data(), piece.size())) > 0;) {
    held += static_cast<std::uint64_t>(n);
    if (held > most)
      throw std::runtime_error("holds more than " + std::to_string(most) +
                               " bytes where it is compressed, far more than its header says");
  }
  int status = Z_OK;
  const std::string message = gzerror(file.get(), &status); // "PATH: reason"
  if (status == Z_BUF_ERROR) throw std::runtime_error("is cut short: what is compressed has no end");
  if (status != Z_OK || gzdirect(file.get()) != 0)
    throw std::runtime_error("is damaged where it is compressed: " +
                             (status == Z_OK ? "incorrect header check" : message.substr(path.size() + 2)));
  if (held < least)
    throw std::runtime_error("is cut short: holds " + std::to_string(held) +
                             " bytes where it is compressed, its header says " + std::to_string(least));
}

Volume read_volume(const std::string& path, const VolumeBytes& bytes) {
  const std::string project = ".inv3";
  if (path.size() > project.size() && path.substr(path.size() - project.size()) == project)
    return read_inv3(path, bytes);
  const vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(path.c_str());
  run_on(path, [&] { run_information(*reader); });
  Volume volume;
  const int* extent = reader->GetDataExtent();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n = static_cast<std::int64_t>(extent[2 * a + 1]) - extent[2 * a] + 1;
    volume.voxels[a] = n > 0 && n < std::numeric_limits<int>::max() ? static_cast<int>(n) : 0;
  }
  if (const int n = reader->GetNumberOfScalarComponents(); n != 1)
    throw std::runtime_error("has " + std::to_string(n) + " numbers a voxel, must have one");
  check_header(*reader, path);
  volume.spacing = voxel_of(*reader);
  const int bytes_a_voxel = vtkDataArray::GetDataTypeSize(reader->GetDataScalarType());
  if (bytes_a_voxel < 1) throw std::runtime_error("has voxels of no type of numbers");
  const std::size_t n =
      checked_voxels(volume.voxels, volume.spacing, static_cast<std::size_t>(bytes_a_voxel), bytes.of_voxels);
  if (bytes.is_compressed)
    check_compressed(path, *reader->GetNIFTIHeader(), bytes, n * static_cast<std::size_t>(bytes_a_voxel));
  run_on(path, [&] { run(*reader); });
  vtkDataArray* numbers = reader->GetOutput()->GetPointData()->GetScalars();
  if (numbers == nullptr || static_cast<std::size_t>(numbers->GetNumberOfValues()) != n)
    throw std::runtime_error("has other voxels than it says");
  const double slope = reader->GetRescaleSlope(), intercept = reader->GetRescaleIntercept();
  volume.intensities.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    const double number = numbers->GetComponent(static_cast<vtkIdType>(v), 0);
    volume.intensities[v] = static_cast<float>(slope != 0 ? slope * number + intercept : number);
  }
  return volume;
}

} // namespace springproof::cases
