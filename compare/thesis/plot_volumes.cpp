#include "compare/thesis/plot_volumes.hpp"

#include "compare/write/gnuplot.hpp"
#include "compare/write/whole_file.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

void plot_volumes(const std::string& folder, const std::string& name,
                  const std::vector<const CaseVolumes*>& volumes, const std::vector<std::string>& labels) {
  std::string boxes =
                  "# position,case,lower_whisker,lower_quartile,median,upper_quartile,upper_whisker (mm3)\n",
              outliers = "# position,volume (mm3) of an outlier\n", tics;
  int position = 0;
  double rest = 1;
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    const std::optional<BoxPlot>& plot = volumes[c]->msm.per_cell;
    if (!plot) continue;
    rest = volumes[c]->rest_per_cell;
    ++position;
    boxes += fmt::format("{},{},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", position, volumes[c]->name,
                         plot->lower_whisker, plot->lower_quartile, plot->median, plot->upper_quartile,
                         plot->upper_whisker);
    for (const double outlier : plot->outliers) outliers += fmt::format("{},{:.8g}\n", position, outlier);
    tics += fmt::format("{}\"{}\" {}", position == 1 ? "" : ", ", labels[c], position);
  }
  if (position == 0) return;
  write_file(folder + "/" + name + ".csv", [&](std::ostream& out) { out << boxes << "\n\n" << outliers; });
  draw(folder, name,
       fmt::format(
           "set xrange [0.4:{}]\nset xtics ({})\nset bmargin 3.5\nset ylabel 'volume of a cell, mm^3'\nunset "
           "grid\nset grid ytics\n"
           "set key outside top center horizontal\nset boxwidth 0.4\n"
           "plot '{}.csv' index 0 using 1:4:3:7:6 with candlesticks whiskerbars 0.5 lt 1 lw 1.5 fc rgb "
           "'#dcecf6' fs "
           "solid border lc rgb '#0072B2' title 'quartiles; whiskers within 1.5 interquartile ranges', "
           "'' index 0 using 1:5:5:5:5 with candlesticks lt 2 lw 3 dt solid title 'median', "
           "'' index 1 using 1:2 with points pt 1 lc rgb '#D55E00' title 'outliers', "
           "{} with lines lt 7 lw 1 title 'at rest'\n",
           position + 0.6, tics, name, rest),
       900, 600);
}

} // namespace springproof::compare
