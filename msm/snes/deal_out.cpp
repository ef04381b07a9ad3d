#include "cases/mesh/mesh.hpp"
#include "mechanics/petsc/handles.hpp"
#include "msm/snes/snes.hpp"

#include <utility>

namespace springproof::msm {

using cases::index;
using grid::Body;
using mechanics::petsc::check;
namespace petsc = mechanics::petsc;

namespace {

/// Least nodes of a brick along an axis that is split: then a coarser brick has one at least.
constexpr int least_nodes = 2;
/// Least nodes of a body that is dealt out: a smaller one's cycle takes less than the messages of its sweeps.
constexpr std::ptrdiff_t least_nodes_in_all = 1000;

using Places = std::array<int, 3>;

int rank_in(MPI_Comm communicator) {
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  return rank;
}

/// How a grid's nodes are dealt out: rank x + px (y + py z) has nodes ends[a][x] to ends[a][x + 1] - 1 along
/// axis a = 0, and so on.
struct Bricks {
  std::array<std::vector<int>, 3> ends; ///< first is 0, last the number of nodes

  int n_along(std::size_t axis) const { return static_cast<int>(ends[axis].size()) - 1; }

  Places place_of(int rank) const {
    return {rank % n_along(0), rank / n_along(0) % n_along(1), rank / n_along(0) / n_along(1)};
  }
  Places first_of(int rank) const {
    const Places at = place_of(rank);
    return {ends[0][index(at[0])], ends[1][index(at[1])], ends[2][index(at[2])]};
  }
  Places last_of(int rank) const {
    const Places at = place_of(rank);
    return {ends[0][index(at[0]) + 1], ends[1][index(at[1]) + 1], ends[2][index(at[2]) + 1]};
  }
  int owner_of(const Places& node) const {
    Places at;
    for (std::size_t a = 0; a < 3; ++a)
      at[a] =
          static_cast<int>(std::upper_bound(ends[a].begin(), ends[a].end(), node[a]) - ends[a].begin()) - 1;
    return at[0] + n_along(0) * (at[1] + n_along(1) * at[2]);
  }

  bool are_large_enough() const {
    std::ptrdiff_t n_nodes = 1;
    for (const std::vector<int>& along : ends) {
      n_nodes *= along.back();
      for (std::size_t i = 0; along.size() > 2 && i + 1 < along.size(); ++i)
        if (along[i + 1] - along[i] < least_nodes) return false;
    }
    return n_nodes >= least_nodes_in_all;
  }
};

/// Bricks for so many ranks with the smallest faces between them; rows stay whole, and then planes, where
/// that makes no difference: kernels run along them.
Bricks bricks_of(const int (&nodes)[3], int n_ranks) {
  Places best{1, 1, n_ranks};
  double least = INFINITY;
  for (int x = 1; x <= n_ranks; ++x)
    for (int y = 1; x * y <= n_ranks; ++y) {
      if (n_ranks % (x * y) != 0) continue;
      const Places along{x, y, n_ranks / (x * y)};
      double faces = 0;
      for (std::size_t a = 0; a < 3; ++a) faces += (along[a] - 1.0) * nodes[(a + 1) % 3] * nodes[(a + 2) % 3];
      if (faces >= least) continue;
      least = faces;
      best = along;
    }
  Bricks bricks;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::ptrdiff_t i = 0; i <= best[a]; ++i)
      bricks.ends[a].push_back(static_cast<int>(i * nodes[a] / best[a]));
  return bricks;
}

Bricks coarsened(const Bricks& fine, const Body& fine_body, const Body& coarse_body) {
  Bricks coarse = fine;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    if (coarse_body.spacing[axis] == fine_body.spacing[axis]) continue;
    for (int& end : coarse.ends[a]) end = (end + 1) / 2;
    coarse.ends[a].back() = coarse_body.layout.nodes[a]; // the last may lie beyond the fine body
  }
  return coarse;
}

class PetscRanks : public grid::Ranks {
 public:
  PetscRanks(const Body& whole, const Body& here, const Bricks& bricks, MPI_Comm communicator)
      : communicator_(communicator), forest_(petsc::get<PetscSF>(PetscSFCreate, communicator)) {
    const grid::Part& part = *here.part;
    std::vector<PetscInt> ghosts;
    std::vector<PetscSFNode> owners;
    grid::for_each_place(here.layout.nodes, [&](int i, int j, int k) {
      if (part.owns(i, j, k)) return;
      const Places node{part.first[0] + i, part.first[1] + j, part.first[2] + k};
      const int owner = bricks.owner_of(node);
      const Owner& there = of(owner, whole, bricks);
      for (int c = 0; c < 3; ++c) {
        ghosts.push_back(static_cast<PetscInt>(here.layout.at(i, j, k, c)));
        owners.push_back(
            {owner, static_cast<PetscInt>(there.layout.at(node[0] - there.first[0], node[1] - there.first[1],
                                                          node[2] - there.first[2], c))});
      }
    });
    const auto n = static_cast<PetscInt>(3 * here.layout.size);
    check(PetscSFSetGraph(forest_.get(), n, static_cast<PetscInt>(ghosts.size()), ghosts.data(),
                          PETSC_COPY_VALUES, owners.data(), PETSC_COPY_VALUES));
    check(PetscSFSetUp(forest_.get()));
  }

  void update_ghosts(double* field) const override { update(MPI_DOUBLE, field); }
  void update_ghosts(float* field) const override { update(MPI_FLOAT, field); }
  void sum(double* values, std::size_t n) const override { reduce(values, n, MPI_DOUBLE, MPI_SUM); }
  void sum(float* values, std::size_t n) const override { reduce(values, n, MPI_FLOAT, MPI_SUM); }
  double largest(double value) const override {
    reduce(&value, 1, MPI_DOUBLE, MPI_MAX);
    return value;
  }

 private:
  MPI_Comm communicator_;
  petsc::StarForest forest_;

  /// Where a neighbour keeps its nodes.
  struct Owner {
    Places first;
    grid::Layout layout;
  };
  std::vector<std::pair<int, Owner>> neighbours_;

  const Owner& of(int rank, const Body& whole, const Bricks& bricks) {
    for (const auto& [known, owner] : neighbours_)
      if (known == rank) return owner;
    Owner owner;
    Places cells;
    const Places first = bricks.first_of(rank), last = bricks.last_of(rank);
    for (std::size_t a = 0; a < 3; ++a) {
      owner.first[a] = std::max(first[a] - 1, 0);
      cells[a] = std::min(last[a] + 1, whole.layout.nodes[a]) - owner.first[a] - 1;
    }
    owner.layout = grid::make_layout(cells);
    return neighbours_.emplace_back(rank, owner).second;
  }

  template<class Real>
  void update(MPI_Datatype type, Real* field) const {
    check(PetscSFBcastBegin(forest_.get(), type, field, field, MPI_REPLACE));
    check(PetscSFBcastEnd(forest_.get(), type, field, field, MPI_REPLACE));
  }

  template<class Real>
  void reduce(Real* values, std::size_t n, MPI_Datatype type, MPI_Op operation) const {
    constexpr std::size_t at_a_time = std::size_t{1} << 27; // MPI counts in int
    for (std::size_t done = 0; done < n; done += at_a_time)
      MPI_Allreduce(MPI_IN_PLACE, values + done, static_cast<int>(std::min(at_a_time, n - done)), type,
                    operation, communicator_);
  }
};

Body part_of(const Body& whole, const Bricks& bricks, MPI_Comm communicator) {
  const int rank = rank_in(communicator);
  Body here = cut_out(whole, bricks.first_of(rank), bricks.last_of(rank));
  here.part->ranks = std::make_shared<PetscRanks>(whole, here, bricks, communicator);
  return here;
}

Body dealt_out(const Body& whole, const Bricks& bricks, MPI_Comm communicator) {
  Body here = part_of(whole, bricks, communicator);
  Body coarse = coarsen(whole).value(); // what is large enough has a coarser one
  const Bricks of_coarse = coarsened(bricks, whole, coarse);
  if (of_coarse.are_large_enough()) {
    here.part->coarser = std::make_shared<Body>(dealt_out(coarse, of_coarse, communicator));
    here.part->coarser_here = here.part->coarser;
  } else {
    here.part->coarser_here = std::make_shared<Body>(part_of(coarse, of_coarse, communicator));
    here.part->coarser = std::make_shared<Body>(std::move(coarse));
  }
  return here;
}

} // namespace

grid::DealOut deal_out_to(MPI_Comm communicator) {
  return [communicator](Body whole) {
    int n_ranks = 1;
    MPI_Comm_size(communicator, &n_ranks);
    const Bricks bricks = bricks_of(whole.layout.nodes, n_ranks);
    return n_ranks > 1 && bricks.are_large_enough() ? dealt_out(whole, bricks, communicator)
                                                    : std::move(whole);
  };
}

} // namespace springproof::msm
