# gnuplot coarse_cells.gp draws coarse_cells.svg, the README's second picture, from coarse_cells.csv.
set encoding utf8
set datafile separator ','
set terminal svg size 1080,600 font 'Sans,13' background 'white'
set output 'coarse_cells.svg'
set border 3 lc rgb '#333333'
set tics nomirror
set grid lc rgb '#dddddd' lt 1 lw 0.5 dt solid
set logscale xy
set xrange [1.8:28]
set yrange [0.1:40]
set xtics (2, 4, 8, 16)
set ytics (0.1, 0.2, 0.5, 1, 2, 5, 10, 20)
set linetype 1 lc rgb '#E69F00' lw 2 dt (12,5) pt 5 ps 0.7
set linetype 2 lc rgb '#009E73' lw 2 dt (3,4) pt 9 ps 0.7
set linetype 3 lc rgb '#0072B2' lw 3 dt solid pt 7 ps 0.7
set linetype 4 lc rgb '#888888' lw 1.5 dt solid pt 6 ps 0.7
set linetype 5 lc rgb '#888888' lw 1.5 dt (12,5) pt 4 ps 0.7
array models = ['springs: hybrid', 'springs: matched', 'springs: midline', 'finite elements: q1\_bbar', 'finite elements: q1\_wilson']
array bodies = ['cube, sheared', 'cube, pulled', 'cube, twisted', 'cantilever 4 : 1', 'beam, both ends clamped', 'wall, pushed', 'block, squeezed']
set multiplot
do for [b = 1:7] {
  place = (b - 1) % 4
  row = (b - 1) / 4
  set lmargin at screen 0.06 + 0.245 * place
  set rmargin at screen 0.06 + 0.245 * place + 0.185
  set tmargin at screen 0.94 - 0.5 * row
  set bmargin at screen 0.60 - 0.5 * row
  set title bodies[b] offset 0, -0.6
  set xlabel (b > 3 ? 'cells across the body' : '') offset 0, 0.5
  set ylabel (place == 0 ? 'error of the displacements, %' : '') offset 1, 0
  set nokey
  plot for [m = 1:5] 'coarse_cells.csv' using ($1 == b ? $3 : NaN):(column(m + 3)) with linespoints lt m notitle
}
set lmargin at screen 0.80
set rmargin at screen 0.98
set tmargin at screen 0.44
set bmargin at screen 0.10
unset border
unset tics
unset grid
unset logscale
unset title
unset xlabel
unset ylabel
set xrange [0:1]
set yrange [0:1]
set key at screen 0.985, 0.36 right top reverse Left spacing 1.5 samplen 3
plot for [m = 1:5] NaN with linespoints lt m title models[m]
