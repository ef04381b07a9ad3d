# Two blocks of data a method, of the variants that a line joins and of the others, then the Pareto front. A marker of 0 is the linetype's.
set linetype 9 lc rgb '#8B0000' lw 2 dt solid pt 15
set linetype 10 lc rgb '#aaaaaa' lw 1 dt solid pt 4
set title headline noenhanced
set logscale xy
set xlabel time_label
set ylabel 'error, %'
set key outside right noenhanced
set format x '%g'
set format y '%g'
set yrange [bottom:*]
if (uncertainty > bottom) {
  set object rectangle from graph 0, graph 0 to graph 1, first uncertainty fc rgb '#dddddd' fs solid noborder behind
}
if (real_time > 0) {
  set arrow from first real_time, graph 0 to first real_time, graph 1 nohead lc rgb '#777777' dt 2
  set label 'real time' at first real_time, graph 0.02 rotate by 90 left offset -1,0 tc rgb '#777777'
}
has_floors = 0
do for [i=1:|methods|] {
  if (floors[i] > 0) { has_floors = 1; set arrow from graph 0, first floors[i] to graph 1, first floors[i] nohead lt linetypes[i] lw 1 dt 3 }
}
marker(i) = markers[i] > 0 ? markers[i] : int(word('7 5 9 13 11 4 6 8 15 4', linetypes[i]))
plot for [i=1:|methods|] points index 2*i-2 using 1:2 with linespoints lt linetypes[i] pt marker(i) title methods[i], \
  for [i=1:|methods|] points index 2*i-1 using 1:2 with points lt linetypes[i] pt marker(i) ps 0.6 notitle, \
  points index 2*|methods| using 1:2 with steps lw 3 lc rgb '#000000' dt solid title 'Pareto front', \
  NaN with boxes fc rgb '#dddddd' fs solid title 'uncertainty of the reference', \
  for [i=1:has_floors] NaN with lines lc rgb '#777777' dt 3 title 'floor of a design'
