set multiplot layout 1,|titles|
set key left top
set yrange [0:*]
set xlabel 'axial logarithmic strain'
set ylabel 'Cauchy stress, MPa'
do for [i=1:|titles|] {
  set title titles[i] noenhanced
  plot data index i-1 using 1:2 with lines lt 7 dt solid lw 3 title 'all springs', \
    '' index i-1 using 1:3 with linespoints lt 2 pi 3 title 'edges', \
    '' index i-1 using 1:4 with linespoints lt 3 pi 3 title 'face diagonals', \
    '' index i-1 using 1:5 with linespoints lt 4 pi 3 title 'internal diagonals'
}
unset multiplot
