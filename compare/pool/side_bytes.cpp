#include "compare/pool/side_bytes.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace compare {

namespace {

/// Both directions visit the same fields in the same order: transfer() below.
class Writer {
 public:
  void raw(const void* from, std::size_t size) { bytes.append(static_cast<const char*>(from), size); }
  template<class Container>
  void resize(Container& container) {
    std::uint64_t size = container.size();
    raw(&size, sizeof size);
  }
  template<class Value>
  void presence(std::optional<Value>& optional) {
    const char present = optional ? 1 : 0;
    raw(&present, 1);
  }
  std::string bytes;
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  void raw(void* to, std::size_t size) {
    if (bytes_.size() - at_ < size) throw std::runtime_error("a stored answer ends too early");
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  template<class Container>
  void resize(Container& container) {
    std::uint64_t size = 0;
    raw(&size, sizeof size);
    if (size > bytes_.size()) throw std::runtime_error("a stored answer has a broken length");
    container.resize(size);
  }
  template<class Value>
  void presence(std::optional<Value>& optional) {
    char present = 0;
    raw(&present, 1);
    if (present)
      optional.emplace();
    else
      optional.reset();
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template<class Archive, class Value>
void transfer(Archive& archive, Value& value);

template<class Archive>
void transfer(Archive& archive, Eigen::Vector3d& vector) {
  archive.raw(vector.data(), 3 * sizeof(double));
}

template<class Archive>
void transfer(Archive& archive, std::string& text) {
  archive.resize(text);
  archive.raw(text.data(), text.size());
}

template<class Archive, class Value>
void transfer(Archive& archive, std::vector<Value>& values) {
  archive.resize(values);
  for (Value& value : values) transfer(archive, value);
}

template<class Archive, class Value>
void transfer(Archive& archive, std::optional<Value>& optional) {
  archive.presence(optional);
  if (optional) transfer(archive, *optional);
}

template<class Archive>
void transfer(Archive& archive, cases::Solution& s) {
  transfer(archive, s.status);
  transfer(archive, s.message);
  transfer(archive, s.outcome);
  transfer(archive, s.displacement);
  transfer(archive, s.cell_volume);
  transfer(archive, s.unknowns);
  transfer(archive, s.residual);
  transfer(archive, s.load_reached);
  transfer(archive, s.newton_iterations);
  transfer(archive, s.relaxation_iterations);
  transfer(archive, s.linear_iterations);
  transfer(archive, s.lowest_eigenvalue);
  transfer(archive, s.negative_eigenvalues);
  transfer(archive, s.inverted_cells);
}

template<class Archive>
void transfer(Archive& archive, Side& side) {
  transfer(archive, side.solution);
  transfer(archive, side.setup_seconds);
  transfer(archive, side.solve_seconds);
}

template<class Archive>
void transfer(Archive& archive, msm::DesignResult& design) {
  transfer(archive, design.stiffness);
  transfer(archive, design.residual);
  transfer(archive, design.moduli);
  transfer(archive, design.warnings);
  transfer(archive, design.cells);
}

template<class Archive>
void transfer(Archive& archive, StudiedMeasure& measure) {
  transfer(archive, measure.name);
  transfer(archive, measure.values);
  transfer(archive, measure.limit);
  transfer(archive, measure.discretisation_error_percent);
  transfer(archive, measure.reason);
}

template<class Archive>
void transfer(Archive& archive, MeshStudy& study) {
  transfer(archive, study.refine);
  transfer(archive, study.unknowns);
  transfer(archive, study.measures);
}

template<class Archive>
void transfer(Archive& archive, Peer& peer) {
  transfer(archive, peer.program);
  transfer(archive, peer.side);
  transfer(archive, peer.largest_difference);
}

template<class Archive>
void transfer_answers(Archive& archive, Comparison& comparison) {
  transfer(archive, comparison.fem);
  transfer(archive, comparison.msm);
  transfer(archive, comparison.design);
  transfer(archive, comparison.mesh_study);
  transfer(archive, comparison.peer);
}

template<class Archive, class Value>
void transfer(Archive& archive, Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>, "a field of this type needs its own transfer()");
  archive.raw(&value, sizeof value);
}

} // namespace

std::string to_bytes(const Comparison& comparison) {
  Writer writer;
  Comparison copy = comparison; // because one transfer() serves both directions
  transfer_answers(writer, copy);
  return writer.bytes;
}

void from_bytes(const std::string& bytes, Comparison& comparison) {
  Reader reader(bytes);
  transfer_answers(reader, comparison);
  if (!reader.at_end()) throw std::runtime_error("a stored answer is too long");
}

} // namespace compare
