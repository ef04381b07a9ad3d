# Three blocks of data a panel: dots, lines between the eigenspaces of both cells, blocks of equivalent ones.
set multiplot layout 1,|titles|
set border 15
unset grid
set size square
set xrange [0.5:24.5]
set yrange [24.5:0.5]
set xtics 4
set ytics 4
unset key
set xlabel 'eigenvectors of the mass-spring cell'
set ylabel 'eigenvectors of the finite element'
do for [i=1:|titles|] {
  set title titles[i]
  plot data index 3*i-1 using (0):(0):1:3:2:4 with boxxyerror fc rgb '#f5d3bd' fs solid noborder, \
    '' index 3*i-2 using 1:2:($3-$1):($4-$2) with vectors nohead lt 1 lw 1 lc rgb '#999999', \
    '' index 3*i-3 using 1:($4 > 0 ? 1/0 : $2):3 with points pt 7 ps variable lt 1, \
    '' index 3*i-3 using 1:($4 > 0 ? $2 : 1/0):3 with points pt 5 ps variable lt 2
}
unset multiplot
