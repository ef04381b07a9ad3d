# The recordings and both models over time: gnuplot -e "out='out/real_beam'" cases/studies/real_beam/courses.gp, after the README's
# commands, in the project's folder. Writes courses.svg there.
set encoding utf8
set datafile separator ','
set terminal svg size 900,900 font 'Sans,13' background 'white'
set output out . '/courses.svg'
set linetype 1 lc rgb '#0072B2' lw 2 dt solid
set linetype 2 lc rgb '#D55E00' lw 2 dt (12,5)
set linetype 3 lc rgb '#444444' pt 7 ps 0.35
set border 3 lc rgb '#333333'
set tics nomirror
set grid lc rgb '#dddddd' lt 1 lw 0.5 dt solid
set xrange [0:1]
set lmargin 9
set ylabel 'mm'
recording(name) = 'cases/studies/real_beam/' . name . '.csv'
motion(name) = out . '/real-beam-' . name . '_motion.csv'
of(measure, value) = strcol(2) eq measure ? value : NaN
array recordings = ['gravity', 'gravity_and_0.510_N', 'gravity_and_1.001_N']
array cases = ['gravity', '52-g', '102-g']
array titles = ['its own weight', 'and 52.0 g on the upper edge of the tip', 'and 102 g there']
set multiplot layout 3, 1
do for [i = 1:3] {
  set title titles[i] offset 0, -0.5
  if (i == 3) { set xlabel 's after the release' }
  if (i == 1) { set key at graph 1, 0.98 right top vertical samplen 3 } else { unset key }
  plot recording(recordings[i]) using 1:4 with points lt 3 title 'recorded', \
       motion(cases[i]) using 4:(of('course', $5)) with lines lt 1 title 'finite elements', \
       motion(cases[i]) using 4:(of('course', $6)) with lines lt 2 title 'springs (hybrid)'
}
unset multiplot
unset output
