#include "fem_reference/grid/slab.hpp"

#include "cases/mesh/mesh.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;

constexpr int fewest_planes = 2; ///< per rank

template<class Real>
MPI_Datatype type_of() {
  return std::is_same_v<Real, float> ? MPI_FLOAT : MPI_DOUBLE;
}

/// Copies a plane of the three components into one piece.
template<class Real>
std::vector<Real> copy_of_plane(const Layout& layout, const Real* field, int plane) {
  std::vector<Real> copy(index(3 * layout.plane));
  for (std::ptrdiff_t c = 0; c < 3; ++c)
    std::copy_n(field + c * layout.size + layout.at(0, 0, plane), layout.plane,
                copy.begin() + c * layout.plane);
  return copy;
}

template<class Real>
void write_plane(const Layout& layout, const std::vector<Real>& from, Real* field, int plane) {
  for (std::ptrdiff_t c = 0; c < 3; ++c)
    std::copy_n(from.begin() + c * layout.plane, layout.plane,
                field + c * layout.size + layout.at(0, 0, plane));
}

/// Sends every rank's piece to all ranks.
/// @param begins  beginnings of the ranks' pieces, in units of n numbers
template<class Real>
void gather(const std::vector<int>& begins, Real* all, std::ptrdiff_t n, MPI_Comm communicator) {
  std::vector<int> counts, places;
  for (std::size_t r = 0; r + 1 < begins.size(); ++r) {
    counts.push_back(static_cast<int>((begins[r + 1] - begins[r]) * n));
    places.push_back(static_cast<int>(begins[r] * n));
  }
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all, counts.data(), places.data(), type_of<Real>(),
                 communicator);
}

} // namespace

Slab::Slab(int n_planes) : begins_{0, n_planes}, layer_begins_{0, n_planes - 1} {
  hold();
}

Slab::Slab(int n_planes, MPI_Comm communicator, int multiple) : Slab(n_planes) {
  int n_ranks = 1, rank = 0;
  MPI_Comm_size(communicator, &n_ranks);
  MPI_Comm_rank(communicator, &rank);
  std::vector<int> begins;
  for (int r = 0; r < n_ranks; ++r)
    // the last ones have a ghost less, and may have a plane more
    begins.push_back((r * n_planes + n_ranks / 2) / n_ranks / multiple * multiple);
  begins.push_back(n_planes);
  for (int r = 0; r < n_ranks; ++r)
    if (begins[index(r) + 1] - begins[index(r)] < fewest_planes) return;
  begins_ = layer_begins_ = begins;
  --layer_begins_.back();
  rank_ = rank;
  communicator_ = communicator;
  hold();
}

void Slab::hold() {
  first_ = is_gathered_ ? 0 : std::max(begin(rank_) - 1, 0);
  n_held_ = (is_gathered_ ? begins_.back() : std::min(begin(rank_ + 1) + 1, begins_.back())) - first_;
}

Slab Slab::coarser(bool along_z, bool is_gathered) const {
  const int n_layers = begins_.back() - 1, factor = along_z ? 2 : 1;
  const int n_coarse = (n_layers + factor - 1) / factor;
  if (!is_shared()) return Slab(n_coarse + 1);
  Slab coarse = *this;
  for (int& begin : coarse.begins_) begin = (begin + factor - 1) / factor;
  for (std::size_t r = 0; r < begins_.size(); ++r) coarse.layer_begins_[r] = begins_[r] / factor;
  coarse.begins_.back() = n_coarse + 1;
  coarse.layer_begins_.back() = n_coarse;
  coarse.is_gathered_ = is_gathered;
  coarse.hold();
  return coarse;
}

bool Slab::can_be_halved() const {
  for (int r = 0; r < n_ranks(); ++r)
    if (begin(r + 1) - begin(r) < 2 * fewest_planes) return false;
  return true;
}

Slab::Range Slab::own() const {
  return {begin(rank_) - first_, begin(rank_ + 1) - first_};
}

Slab::Range Slab::own_layers() const {
  return {layer_begin(rank_) - first_, layer_begin(rank_ + 1) - first_};
}

/// Sends a plane to one rank and returns what comes from another; either may be MPI_PROC_NULL, which is none.
template<class Real>
std::vector<Real> Slab::exchange(const std::vector<Real>& sent, int to, int from) const {
  std::vector<Real> received(sent.size());
  const int n = static_cast<int>(sent.size());
  MPI_Sendrecv(sent.data(), n, type_of<Real>(), to, 0, received.data(), n, type_of<Real>(), from, 0,
               communicator_, MPI_STATUS_IGNORE);
  return received;
}

template<class Real>
void Slab::complete(const Layout& layout, Real* field) const {
  if (n_ranks() == 1) return;
  if (is_gathered_) {
    for (std::ptrdiff_t c = 0; c < 3; ++c)
      gather(begins_, field + c * layout.size + layout.lead, layout.plane, communicator_);
    return;
  }
  const auto [begin, end] = own();
  const auto pass_on = [&](int sent, int to, int received, int from) {
    const std::vector<Real> plane = exchange(copy_of_plane(layout, field, sent), to, from);
    if (from != MPI_PROC_NULL) write_plane(layout, plane, field, received);
  };
  pass_on(begin, below(), end, above());
  pass_on(end - 1, above(), begin - 1, below());
}

/// Where a boundary between ranks cuts a coarse layer, the rank above has all of its fine layers; where it
/// does not, either rank lacks those of the layer beyond it, and only the rank above holds that one.
template<class Real>
void Slab::complete_layers(Real* layers, std::ptrdiff_t n) const {
  if (n_ranks() == 1) return;
  if (is_gathered_) return gather(layer_begins_, layers, n, communicator_);
  std::array<MPI_Request, 2> requests{MPI_REQUEST_NULL, MPI_REQUEST_NULL}; // both are under way at once
  for (const int upper : {rank_, rank_ + 1}) {
    const int other = upper == rank_ ? rank_ - 1 : upper;
    if (other < 0 || other == n_ranks()) continue;
    const bool is_upper = upper == rank_, upper_has_it = layer_begin(upper) < begin(upper);
    Real* const layer = layers + (begin(upper) - 1 - first_) * n;
    MPI_Request& request = requests[index(upper - rank_)];
    if (is_upper == upper_has_it)
      MPI_Isend(layer, static_cast<int>(n), type_of<Real>(), other, 0, communicator_, &request);
    else
      MPI_Irecv(layer, static_cast<int>(n), type_of<Real>(), other, 0, communicator_, &request);
  }
  MPI_Waitall(2, requests.data(), MPI_STATUSES_IGNORE);
}

void Slab::add_to_next(const Layout& layout, double* field) const {
  if (!is_shared()) return;
  const auto [begin, end] = own();
  const std::vector<double> plane =
      exchange(copy_of_plane(layout, static_cast<const double*>(field), end), above(), below());
  if (below() == MPI_PROC_NULL) return;
  for (std::ptrdiff_t c = 0; c < 3; ++c)
    for (std::ptrdiff_t i = 0; i < layout.plane; ++i)
      field[c * layout.size + layout.at(0, 0, begin) + i] += plane[index(c * layout.plane + i)];
}

double Slab::largest(double value) const {
  if (is_shared()) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  return value;
}

double Slab::total(double value) const {
  if (is_shared()) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, communicator_);
  return value;
}

double Slab::total(const std::vector<double>& of_planes) const {
  std::vector<double> all = of_planes;
  if (is_shared()) {
    all.assign(index(begins_.back()), 0);
    std::copy(of_planes.begin(), of_planes.end(), all.begin() + begin(rank_));
    gather(begins_, all.data(), 1, communicator_);
  }
  double sum = 0;
  for (const double value : all) sum += value;
  return sum;
}

template void Slab::complete(const Layout&, float*) const;
template void Slab::complete(const Layout&, double*) const;
template void Slab::complete_layers(float*, std::ptrdiff_t) const;
template void Slab::complete_layers(double*, std::ptrdiff_t) const;

} // namespace springproof::fem_reference::grid
