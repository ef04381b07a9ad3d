#include "fem_reference/grid/stencil_levels.hpp"
#include "mechanics/dense.hpp"

#include <cmath>

namespace springproof::fem_reference::grid {

namespace {

constexpr int fewest_steps = 6, most_steps = 60;
constexpr int most_runs = 20;
/// Bound on a Ritz value's error over its size, for its sign to be believed.
constexpr double sign_is_known = 0.2;

/// A vector and its product with the inverse of the preconditioner.
struct Pair {
  Field<float> primal, dual;
};

using Product = std::function<void(Field<double>&, Field<double>&)>;

class Lanczos {
 public:
  Lanczos(const Body& body, const Product& product, StencilLevels& multigrid)
      : body_(body), times_(product), multigrid_(multigrid), space_(multigrid.space()) {}

  /// One run from a random vector.  @return number of negative eigenvalues found; they are deflated next time
  int run() {
    basis_.clear();
    Field<double> right = random_field(), vector = Field<double>::Zero(right.size()), product = vector;
    Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(most_steps, most_steps);
    double last = 0; // length of the part of a product that is new
    mechanics::Spectrum ritz;
    Eigen::VectorXd errors;
    for (int step = 0;; ++step) {
      orthogonalise(right);
      multigrid_.apply(right, vector);
      const double squared = dot(space_, right, vector);
      if (step > 0) {
        last = std::sqrt(std::max(squared, 0.));
        const Eigen::MatrixXd block = projected.topLeftCorner(step, step);
        ritz = mechanics::spectrum((block + block.transpose()) / 2);
        errors = last * ritz.vectors.row(step - 1).transpose().cwiseAbs();
        if (step == most_steps || !(squared > 0) || (step >= fewest_steps && is_known(ritz.values, errors)))
          break;
      }
      if (!(squared > 0)) return 0;
      const double unit = 1 / std::sqrt(squared);
      basis_.push_back({(unit * vector).cast<float>(), (unit * right).cast<float>()});
      vector *= unit;
      times_(vector, product);
      ++n_products;
      right = product;
      for (int row = 0; row <= step; ++row)
        projected(row, step) = dot(space_, product, basis_[static_cast<std::size_t>(row)].primal);
      for (int row = 0; row < step; ++row) projected(step, row) = row + 1 == step ? last : 0;
    }
    int n_negative = 0;
    for (Eigen::Index r = 0; r < ritz.values.size() && ritz.values[r] < 0; ++r) {
      ++n_negative;
      Pair mode{Field<float>::Zero(right.size()), Field<float>::Zero(right.size())};
      for (std::size_t j = 0; j < basis_.size(); ++j) {
        const auto weight = static_cast<float>(ritz.vectors(static_cast<Eigen::Index>(j), r));
        mode.primal += weight * basis_[j].primal;
        mode.dual += weight * basis_[j].dual;
      }
      found_.push_back(std::move(mode));
    }
    return n_negative;
  }

  long n_products = 0;

 private:
  const Body& body_;
  const Product& times_;
  StencilLevels& multigrid_;
  const Space& space_;
  std::vector<Pair> basis_, found_;
  unsigned n_runs_ = 0;

  Field<double> random_field() {
    Field<double> field =
        mechanics::grid::random_field<double>(body_.layout, {0, 0, body_.slab.first_of_grid()}, ++n_runs_ + 2,
                                              std::uniform_real_distribution<double>(-1, 1));
    field.array() *= body_.free.cast<double>().array();
    return field;
  }

  /// Makes a vector orthogonal to all vectors so far, in the preconditioner's inner product.
  void orthogonalise(Field<double>& right) const {
    for (int pass = 0; pass < 2; ++pass)
      for (const auto* vectors : {&found_, &basis_})
        for (const Pair& pair : *vectors) right -= dot(space_, right, pair.primal) * pair.dual.cast<double>();
  }

  /// Whether the signs of the negative values and of the lowest other one are known.
  static bool is_known(const Eigen::VectorXd& values, const Eigen::VectorXd& errors) {
    for (Eigen::Index r = 0; r < values.size(); ++r) {
      if (!(errors[r] <= sign_is_known * std::abs(values[r]))) return false;
      if (values[r] > 0) return true;
    }
    return false;
  }
};

} // namespace

int count_negative_eigenvalues(const Body& body, const Product& product, StencilLevels& multigrid,
                               long& linear_iterations) {
  Lanczos lanczos(body, product, multigrid);
  int total = 0;
  for (int run = 0; run < most_runs; ++run) {
    const int found = lanczos.run();
    total += found;
    if (found == 0) break;
  }
  linear_iterations += lanczos.n_products;
  return total;
}

} // namespace springproof::fem_reference::grid
