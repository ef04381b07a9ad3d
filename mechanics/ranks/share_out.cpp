#include "mechanics/ranks/share_out.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace springproof::mechanics {

namespace {

using cases::index;
using cases::Numbered;
using cases::Range;
using cases::Share;
using Eigen::Vector3d;

/// MPI counts in int: messages are counted in values, not in bytes.
class ValueType {
 public:
  explicit ValueType(std::size_t size) {
    MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~ValueType() { MPI_Type_free(&type_); }
  ValueType(const ValueType&) = delete;
  ValueType& operator=(const ValueType&) = delete;
  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

/// Where each rank's values begin, and where the last one's end.
std::vector<int> begins_of(const std::vector<int>& counts) {
  std::vector<int> begins(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), begins.begin() + 1);
  return begins;
}

class MpiSharing : public cases::Sharing {
 public:
  MpiSharing(const Share& share, MPI_Comm communicator, int n_ranks)
      : Sharing(share), communicator_(communicator), shares_(index(n_ranks)) {
    static_assert(sizeof(Share) == 6 * sizeof(std::size_t));
    MPI_Allgather(&share, sizeof share, MPI_BYTE, shares_.data(), sizeof share, MPI_BYTE, communicator);
  }

  double sum(double value) const override {
    std::vector<double> all(shares_.size());
    MPI_Allgather(&value, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, communicator_);
    return std::accumulate(all.begin(), all.end(), 0.0);
  }

  double largest(double value) const override {
    std::array<double, 2> found{std::isnan(value) ? 1. : 0., std::isnan(value) ? 0 : value};
    MPI_Allreduce(MPI_IN_PLACE, found.data(), 2, MPI_DOUBLE, MPI_MAX, communicator_);
    return found[0] > 0 ? std::nan("") : found[1];
  }

  Vector3d at(std::size_t node, const std::vector<Vector3d>& held) const override {
    const auto owner = std::find_if(shares_.begin(), shares_.end(),
                                    [&](const Share& share) { return share.own_nodes.has(node); });
    Vector3d value = Vector3d::Zero();
    if (here().own_nodes.has(node)) value = held[node - here().nodes.begin];
    MPI_Bcast(value.data(), 3, MPI_DOUBLE, static_cast<int>(owner - shares_.begin()), communicator_);
    return value;
  }

  std::vector<Vector3d> deal(std::vector<Numbered<Vector3d>> of_nodes) const override {
    std::vector<Vector3d> held(here().nodes.size(), Vector3d::Zero());
    for (const auto& [number, value] : exchange(std::move(of_nodes), &Share::nodes))
      held[index(number) - here().nodes.begin] = value;
    return held;
  }
  std::vector<double> deal(std::vector<Numbered<double>> of_cells) const override {
    std::vector<double> held(here().cells.size(), 0.);
    for (const auto& [number, value] : exchange(std::move(of_cells), &Share::cells))
      held[index(number) - here().cells.begin] += value;
    return held;
  }

  std::vector<Vector3d> add_up(std::vector<Numbered<Vector3d>> of_nodes) const override {
    std::vector<Vector3d> held(here().nodes.size(), Vector3d::Zero());
    for (const auto& [number, value] : exchange(std::move(of_nodes), &Share::nodes))
      held[index(number) - here().nodes.begin] += value;
    return held;
  }

  std::vector<Vector3d> gather(const std::vector<Vector3d>& of_nodes) const override {
    const std::size_t ghosts = here().own_nodes.begin - here().nodes.begin;
    return gathered(of_nodes.data() + ghosts, &Share::own_nodes);
  }
  std::vector<double> gather(const std::vector<double>& of_cells) const override {
    return gathered(of_cells.data(), &Share::cells);
  }

 private:
  MPI_Comm communicator_;
  std::vector<Share> shares_; ///< one per rank

  /// Returns what all ranks have for this one, in the order of the ranks.
  /// @param part  the range of a share that the numbers belong to
  template<class Value>
  std::vector<Numbered<Value>> exchange(std::vector<Numbered<Value>> values, Range Share::*part) const {
    const auto is_before = [](const Numbered<Value>& a, const Numbered<Value>& b) {
      return a.number < b.number;
    };
    if (!std::is_sorted(values.begin(), values.end(), is_before))
      std::stable_sort(values.begin(), values.end(), is_before);
    const auto first_from = [&](std::size_t number) {
      return std::lower_bound(values.begin(), values.end(),
                              Numbered<Value>{static_cast<std::int64_t>(number), {}}, is_before);
    };
    std::vector<Numbered<Value>> sent;
    std::vector<int> n_sent, n_received(shares_.size());
    for (const Share& share : shares_) {
      const auto begin = first_from((share.*part).begin), end = first_from((share.*part).end);
      n_sent.push_back(static_cast<int>(end - begin));
      sent.insert(sent.end(), begin, end);
    }
    values = {};
    MPI_Alltoall(n_sent.data(), 1, MPI_INT, n_received.data(), 1, MPI_INT, communicator_);
    const std::vector<int> from = begins_of(n_sent), to = begins_of(n_received);
    std::vector<Numbered<Value>> received(index(to.back()));
    const ValueType type(sizeof(Numbered<Value>));
    MPI_Alltoallv(sent.data(), n_sent.data(), from.data(), type.get(), received.data(), n_received.data(),
                  to.data(), type.get(), communicator_);
    return received;
  }

  template<class Value>
  std::vector<Value> gathered(const Value* own, Range Share::*part) const {
    std::vector<int> counts;
    for (const Share& share : shares_) counts.push_back(static_cast<int>((share.*part).size()));
    const std::vector<int> begins = begins_of(counts);
    std::vector<Value> all(index(begins.back()));
    const ValueType type(sizeof(Value));
    MPI_Allgatherv(own, static_cast<int>((here().*part).size()), type.get(), all.data(), counts.data(),
                   begins.data(), type.get(), communicator_);
    return all;
  }
};

} // namespace

bool is_mpi_started() {
  int is_started = 0;
  MPI_Initialized(&is_started);
  return is_started != 0;
}

std::shared_ptr<const cases::Sharing> share_out(const cases::Mesh& mesh, MPI_Comm communicator) {
  if (!is_mpi_started()) return nullptr;
  int rank = 0, n_ranks = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  if (n_ranks == 1) return nullptr;
  return std::make_shared<MpiSharing>(share_of(mesh, rank, n_ranks), communicator, n_ranks);
}

} // namespace springproof::mechanics
