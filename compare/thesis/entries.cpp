#include "compare/thesis/regenerate.hpp"

#include "compare/solve/springs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace springproof::compare {

namespace {

bool have_one_measure(const PublishedFigure& a, const PublishedFigure& b) {
  return a.material == b.material && a.poissons_ratio == b.poissons_ratio && a.design == b.design &&
         a.design_poissons_ratio == b.design_poissons_ratio && a.load_set == b.load_set &&
         a.measure == b.measure;
}

/// The published figure of another test of the same material and springs, in whichever table.
std::optional<double> published_value(const PublishedFigure& figure) {
  for (const PublishedFigure& other : published_figures())
    if (have_one_measure(other, figure)) return other.value;
  return std::nullopt;
}

/// Figure of the small test that a beta_1 is compared with.
PublishedFigure small_beta_2(PublishedFigure figure) {
  figure.load_set = "small";
  figure.measure = "beta_2";
  return figure;
}

/// What a beta_1 would err by if it were 45 deg + beta_2 of the small test: with our springs, and with
/// springs that have the published error of beta_2.
/// @param figure  that beta_2
void add_readings_from_beta_2(ComputedFigure& computed, const PublishedFigure& figure,
                              const FemChoice& reference, const Solutions& solutions) {
  const JobPair jobs = thesis_jobs(figure, reference);
  const MeasuredPair beta = measured_pair(solutions, jobs, figure.measure);
  if (!beta.fem) return;
  const auto with_error = [&](const std::optional<double>& error) { // (45 + b (1 + r))/(45 + b) - 1
    return error ? std::optional(*beta.fem * *error / (45 + *beta.fem)) : std::nullopt;
  };
  computed.from_beta_2 = with_error(beta.error());
  computed.from_printed_beta_2 = with_error(published_value(figure));
}

ComputedFigure compute(const PublishedFigure& figure, const FemChoice& reference,
                       const Solutions& solutions) {
  const JobPair jobs = thesis_jobs(figure, reference);
  const MeasuredPair pair = measured_pair(solutions, jobs, figure.measure);
  ComputedFigure computed{reference.name, figure.unit == "mm3" ? pair.msm : pair.error(), pair.fem, pair.msm};
  if (!computed.value) computed.reason = pair.reason;
  if (figure.measure == "beta_1")
    add_readings_from_beta_2(computed, small_beta_2(figure), reference, solutions);
  computed.trace = trace_of(jobs);
  return computed;
}

/// Rounding of print, and of the stiffnesses behind it: what counts as the same figure, points.
constexpr double same_figure = 0.1;
/// Near enough to be worth a hint, points.
constexpr double similar_figure = 0.5;

/// Finds what a printed beta_1 is: some rows hold another quantity's error. The definition in the text gives
/// a beta_1 that errs about as much as beta_2 does.
std::string explain_beta_1(const TableEntry& entry) {
  const auto [c, reading] = nearest_from_beta_2(entry);
  const double off = std::abs(reading - entry.published.value);
  if (!c || !(off <= similar_figure))
    return "not beta_1 as the text defines it, nor any other quantity that was tried";
  const std::string what =
      fmt::format("the error of 45 deg + beta_2 of the small test, {:.2f} with {}{}", reading, c->reference,
                  reading == c->from_beta_2 ? "" : " and the printed error of beta_2");
  return (off <= same_figure ? "not beta_1: print holds " : "not beta_1, perhaps ") + what;
}

/// The printed tilt of the left edge under the large shear lies above that reference which meets the tilt of
/// the right edge, although both come from the same two solutions.
std::string explain_alpha_1(const TableEntry& entry, const std::vector<TableEntry>& entries) {
  PublishedFigure beside = entry.published;
  beside.measure = "alpha_2";
  for (const TableEntry& alpha_2 : entries) {
    const PublishedFigure& p = alpha_2.published;
    const ComputedFigure* right = alpha_2.nearest();
    if (!right || !have_one_measure(p, beside) || p.table != beside.table || p.test != beside.test) continue;
    const ComputedFigure& left = entry.computed[right - alpha_2.computed.data()];
    if (left.value && beside.value - *left.value > 1)
      return fmt::format(
          "print lies {:.1f} points above {}, which meets alpha_2 of the same two solutions within {:.1f}",
          beside.value - *left.value, left.reference, std::abs(*right->value - p.value));
  }
  return "";
}

bool is_met(const ComputedFigure& computed, const PublishedFigure& published, double bound) {
  // A difference that is the bound but for rounding of the two figures' decimals counts as within.
  return computed.value && std::abs(*computed.value - published.value) <= bound * (1 + 1e-12);
}

Within count(const std::vector<const TableEntry*>& entries, double bound) {
  Within within{bound, 0, 0, 0};
  for (const TableEntry* entry : entries) {
    const auto is_met_here = [&](const ComputedFigure& c) { return is_met(c, entry->published, bound); };
    const auto& computed = entry->computed;
    const auto first = std::find_if(computed.begin(), computed.end(), is_met_here);
    ++(first == computed.end()     ? within.neither
       : first == computed.begin() ? within.declared
                                   : within.other_only);
  }
  return within;
}

/// A kind of figure, which is counted by itself.
struct Kind {
  const char *name, *unit;
  std::vector<double> bounds;
  double listing_bound;
};

// A figure of one cell is exact: half a unit of the last printed digit is all that may be between, twice that
// where the thesis computed from rounded stiffnesses.
const Kind kinds[] = {{"errors, beta_1 aside", "points", {0.1, 0.5, 1, 2}, 1},
                      {"errors in beta_1", "points", {0.1, 0.5, 1, 2}, 1},
                      {"volumes (5.2)", "mm3", {0.1, 0.5, 1, 2}, 2},
                      {"bar (5.12)", "points", {0.1, 0.5, 1, 1.6, 2}, 1.6},
                      {"pseudo-stiffnesses (4.1)", "", {0.0005, 0.001, 0.002}, 0.0005},
                      {"eigenvalues and multiplicities (4.2), h (4.3)", "", {0.005, 0.01, 0.02}, 0.005}};

/// The name of its kind.
std::string kind_of(const PublishedFigure& figure) {
  if (figure.test == "cell") return kinds[figure.table == "4.1" ? 4 : 5].name;
  if (figure.table == "5.12") return kinds[3].name;
  if (figure.unit == "mm3") return kinds[2].name;
  return kinds[figure.measure == "beta_1" ? 1 : 0].name;
}

constexpr double cell_edge = 2;    // mm; thesis section 4.2.2
constexpr double cell_modulus = 1; // MPa: with this edge k' = 2 k/(L0 E) is k itself

Spectrum springs_spectrum(const msm::CellStiffness& stiffness) {
  return mechanics::spectrum(msm::cell_stiffness_matrix(msm::cube(cell_edge), stiffness));
}

CellAnalysis analyse_cell(double poissons_ratio) {
  const cases::LinearElastic material{cell_modulus, poissons_ratio};
  cases::Msm options;
  options.design = cases::Design::linear_method;
  const msm::DesignRequest request = design_request(material, msm::cube(cell_edge), options);
  const msm::CellStiffness stiffness = msm::design(request).stiffness;
  return {poissons_ratio, stiffness,
          analyse_eigenspaces(mechanics::spectrum(request.element_stiffness(material)),
                              springs_spectrum(stiffness))};
}

/// "fem_eigenvalue_2" -> model "fem", what "eigenvalue", index 1.
std::optional<double> spectrum_figure(const std::string& measure, const EigenspaceAnalysis& spaces) {
  const std::size_t first = measure.find('_'), last = measure.rfind('_');
  const std::string what = measure.substr(first + 1, last - first - 1);
  const auto& of_model = measure.substr(0, first) == "fem" ? spaces.fem_spaces : spaces.msm_spaces;
  const std::size_t index = std::stoul(measure.substr(last + 1)) - 1;
  if (index >= of_model.size()) return std::nullopt;
  return what == "eigenvalue" ? of_model[index].eigenvalue : of_model[index].dimension;
}

std::optional<double> figure_of(const CellAnalysis& cell, const std::string& measure) {
  if (measure == "edge") return cell.stiffness.edge;
  if (measure == "face_diagonal") return cell.stiffness.face_diagonal;
  if (measure == "internal_diagonal") return cell.stiffness.internal_diagonal;
  return measure == "h" ? cell.spaces.h : spectrum_figure(measure, cell.spaces);
}

Trace cell_trace(const PublishedFigure& figure) {
  const std::string nu = fmt::format("{}", figure.poissons_ratio);
  if (figure.table != "4.1") return {"", {}, shell_command({"eigen", "--poisson", nu})};
  // With E = 0.001 MPa and L0 = 2 mm the stiffnesses in N/m are the pseudo-stiffnesses.
  return {"",
          {},
          shell_command(
              {"design", "--young", "0.001", "--edge", "2", "--poisson", nu, "--method", "linear_method"})};
}

/// Stiffnesses as table 4.1 prints them, to three digits.
std::optional<msm::CellStiffness> printed_stiffness(double poissons_ratio) {
  std::vector<double> k;
  for (const PublishedFigure& figure : published_figures())
    if (figure.table == "4.1" && figure.poissons_ratio == poissons_ratio) k.push_back(figure.value);
  return k.size() == 3 ? std::optional(msm::CellStiffness{k[0], k[1], k[2]}) : std::nullopt;
}

/// What lies between print and us beyond the rounding of the last printed digit.
std::string explain_cell(const PublishedFigure& figure, double computed) {
  const double half_digit = figure.table == "4.1" ? 0.0005 : 0.005;
  const double off = std::abs(computed - figure.value);
  if (off <= half_digit) return "";
  if (figure.measure.rfind("msm_eigenvalue", 0) == 0)
    if (const auto k = printed_stiffness(figure.poissons_ratio)) {
      const Spectrum springs = springs_spectrum(*k);
      const auto value = spectrum_figure(figure.measure, analyse_eigenspaces(springs, springs));
      if (value && std::abs(*value - figure.value) <= half_digit)
        return fmt::format("met with the stiffnesses of table 4.1 as printed: {:.4f}", *value);
    }
  return off <= 2 * half_digit ? "one unit of the last printed digit" : "";
}

} // namespace

std::optional<double> TableEntry::difference(const ComputedFigure& of) const {
  return of.value ? std::optional(*of.value - published.value) : std::nullopt;
}

bool TableEntry::has_failed() const {
  return std::any_of(computed.begin(), computed.end(), [](const ComputedFigure& c) { return !c.value; });
}

const ComputedFigure* TableEntry::nearest() const {
  const ComputedFigure* best = nullptr;
  for (const ComputedFigure& candidate : computed)
    if (candidate.value && (!best || std::abs(*difference(candidate)) < std::abs(*difference(*best))))
      best = &candidate;
  return best;
}

std::vector<JobPair> entry_jobs(const PublishedFigure& figure) {
  std::vector<JobPair> jobs;
  for (const FemChoice& reference : references_of(figure)) {
    jobs.push_back(thesis_jobs(figure, reference));
    if (figure.measure == "beta_1") jobs.push_back(thesis_jobs(small_beta_2(figure), reference));
  }
  return jobs;
}

std::vector<TableEntry> error_entries(const std::vector<PublishedFigure>& figures,
                                      const Solutions& solutions) {
  std::vector<TableEntry> entries;
  for (const PublishedFigure& figure : figures) {
    if (figure.test == "cell") continue;
    TableEntry entry{figure, {}, ""};
    for (const FemChoice& reference : references_of(figure))
      entry.computed.push_back(compute(figure, reference, solutions));
    entries.push_back(std::move(entry));
  }
  return entries;
}

BetaReading nearest_from_beta_2(const TableEntry& entry) {
  BetaReading nearest{nullptr, 0};
  const double published = entry.published.value;
  for (const ComputedFigure& c : entry.computed)
    for (const auto& reading : {c.from_beta_2, c.from_printed_beta_2})
      if (reading &&
          (!nearest.reference || std::abs(*reading - published) < std::abs(nearest.value - published)))
        nearest = {&c, *reading};
  return nearest;
}

void explain(std::vector<TableEntry>& entries) {
  for (TableEntry& entry : entries) {
    const PublishedFigure& p = entry.published;
    if (p.measure == "beta_1") entry.finding = explain_beta_1(entry);
    if (p.measure == "alpha_1" && p.load_set == "large") entry.finding = explain_alpha_1(entry, entries);
  }
}

std::vector<SummaryGroup> summarise(const std::vector<TableEntry>& entries) {
  std::vector<SummaryGroup> groups;
  for (const Kind& kind : kinds) {
    std::vector<const TableEntry*> members;
    std::set<std::string> tables;
    for (const TableEntry& entry : entries)
      if (kind_of(entry.published) == kind.name) {
        members.push_back(&entry);
        tables.insert(entry.published.table);
      }
    if (members.empty()) continue;
    SummaryGroup group{kind.name, kind.unit, static_cast<int>(members.size()), {}, kind.listing_bound};
    group.command = fmt::format("build/springproof tables {}", fmt::join(tables, " "));
    for (const double bound : kind.bounds) group.within.push_back(count(members, bound));
    for (const TableEntry* entry : members) {
      const bool is_beyond = count({entry}, kind.listing_bound).neither == 1;
      if (is_beyond) group.beyond.push_back(entry);
      if (entry->has_failed())
        ++group.n_failed;
      else if (!is_beyond)
        ++group.n_reproduced;
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

std::vector<CellAnalysis> analyse_cells(const std::vector<PublishedFigure>& figures) {
  std::set<double> ratios;
  for (const PublishedFigure& figure : figures)
    if (figure.test == "cell") ratios.insert(figure.poissons_ratio);
  std::vector<CellAnalysis> cells;
  for (const double nu : ratios) cells.push_back(analyse_cell(nu));
  return cells;
}

std::vector<TableEntry> cell_entries(const std::vector<PublishedFigure>& figures,
                                     const std::vector<CellAnalysis>& cells) {
  std::vector<TableEntry> entries;
  for (const PublishedFigure& figure : figures) {
    if (figure.test != "cell") continue;
    ComputedFigure computed{"one q1 cell"};
    for (const CellAnalysis& cell : cells)
      if (cell.poissons_ratio == figure.poissons_ratio) computed.value = figure_of(cell, figure.measure);
    if (!computed.value) computed.reason = "the cell has no " + figure.measure;
    computed.trace = cell_trace(figure);
    entries.push_back({figure, {computed}, computed.value ? explain_cell(figure, *computed.value) : ""});
  }
  return entries;
}

} // namespace springproof::compare
