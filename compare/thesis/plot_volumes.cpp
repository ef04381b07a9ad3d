#include "compare/thesis/plot_volumes.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/write/csv.hpp"
#include "compare/write/gnuplot.hpp"

#include <sstream>

namespace springproof::compare {

void plot_volumes(const std::string& folder, const std::string& name,
                  const std::vector<const CaseVolumes*>& volumes, const std::vector<std::string>& labels) {
  std::vector<std::string> drawn;
  double rest = 1;
  std::ostringstream boxes, outliers;
  CsvWriter box(boxes), outlier(outliers);
  box.row("# position", "case", "lower_whisker", "lower_quartile", "median", "upper_quartile",
          "upper_whisker (mm3)");
  outlier.row("# position", "volume (mm3) of an outlier");
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    const std::optional<BoxPlot>& plot = volumes[c]->msm.per_cell;
    if (!plot) continue;
    rest = volumes[c]->rest_per_cell;
    drawn.push_back(labels[c]);
    box.row(drawn.size(), volumes[c]->name, plot->lower_whisker, plot->lower_quartile, plot->median,
            plot->upper_quartile, plot->upper_whisker);
    for (const double volume : plot->outliers) outlier.row(drawn.size(), volume);
  }
  if (drawn.empty()) return;
  box.end_block();
  write_file(folder + "/" + name + ".csv", [&](std::ostream& out) { out << boxes.str() << outliers.str(); });
  draw(folder, name, "volumes", {{"labels", drawn}, {"rest", rest}, {"width", 900.}});
}

} // namespace springproof::compare
