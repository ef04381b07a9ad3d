set key top left
set logscale x
set xlabel 'worst error on the cube, %'
set ylabel 'logarithmic strain to which the lattice is stable'
set offsets graph 0.1, graph 0.3, graph 0.1, graph 0.1
plot data using 2:($4 == 0 ? $3 : 1/0) with points pt 6 lc rgb '#777777' title 'dominated', \
  '' using 2:($4 == 1 ? $3 : 1/0) with points pt 7 ps 1.3 lc rgb '#D55E00' title 'Pareto front', \
  '' using 2:3:(stringcolumn(1)) with labels left offset 1,0 font ',9' noenhanced notitle
