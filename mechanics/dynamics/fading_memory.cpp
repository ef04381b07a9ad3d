#include "mechanics/dynamics/fading_memory.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::mechanics {

namespace {

/// q1 = kept q0 + taken part (s1 - s0).
struct Fading {
  double kept, taken;
};
Fading fading(double duration, double tau) {
  const double x = duration / tau;
  return {std::exp(-x), x > 0 ? -std::expm1(-x) / x : 1};
}

} // namespace

std::vector<PronyBranch> prony_branches(const cases::Case& definition) {
  std::vector<PronyBranch> branches;
  const std::size_t n_materials = 1 + definition.region_materials.size();
  for (std::size_t m = 0; m < n_materials; ++m) {
    PronyBranch::Parts left{1, 1};
    for (const cases::PronyTerm& term : dynamics_of(definition, m).prony) left.g -= term.g, left.k -= term.k;
    for (const cases::PronyTerm& term : dynamics_of(definition, m).prony) {
      auto same = std::find_if(branches.begin(), branches.end(),
                               [&](const PronyBranch& one) { return one.tau == term.tau; });
      if (same == branches.end())
        same = branches.insert(same, {term.tau, std::vector<PronyBranch::Parts>(n_materials)});
      same->of_material[m].g += term.g / left.g;
      same->of_material[m].k += term.k / left.k;
    }
  }
  return branches;
}

FadingMemory::FadingMemory(const std::vector<Branch>& branches) {
  for (const Branch& branch : branches) states_.push_back({branch, Vector::Zero(branch.part.size())});
  if (!branches.empty()) begin(Vector::Zero(branches.front().part.size()));
}

void FadingMemory::begin(const Vector& elastic) {
  last_ = elastic;
  for (State& state : states_) state.faded.setZero();
  set_step(INFINITY);
}

void FadingMemory::set_step(double duration) {
  factor_.setOnes(last_.size());
  remembered_.setZero(last_.size());
  for (const auto& [branch, faded] : states_) {
    const Fading over = fading(duration, branch.tau);
    factor_ += over.taken * branch.part;
    remembered_ += over.kept * faded - over.taken * branch.part.cwiseProduct(last_);
  }
}

void FadingMemory::end_step(const Vector& elastic, double length) {
  for (auto& [branch, faded] : states_) {
    const Fading over = fading(length, branch.tau);
    faded = over.kept * faded + over.taken * branch.part.cwiseProduct(elastic - last_);
  }
  last_ = elastic;
}

} // namespace springproof::mechanics
