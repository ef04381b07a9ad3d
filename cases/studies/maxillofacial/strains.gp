# Drawn by strains.py.
set encoding utf8
set terminal pngcairo size 900,420 font 'Sans,11' background 'white'
set output out . '/strains.png'
set pm3d map corners2color c1
set palette defined (0 '#440154', 0.25 '#3b528b', 0.5 '#21918c', 0.75 '#5ec962', 1 '#fde725')
set cbrange [0:0.34]
set cblabel 'largest principal strain'
set size ratio -1
set xrange [0:37]
set yrange [0:13]
set ytics 5
unset key
set border 3
set tics nomirror
array methods = ['sdm', 'rm']
array models = ['fem', 'msm']
array names = ['scaled (SDM)', 'removed (RM)']
array sides = ['finite elements', 'springs']
set multiplot layout 2, 2 margins 0.05, 0.87, 0.06, 0.93 spacing 0.04, 0.1
do for [i = 1:2] { do for [j = 1:2] {
  if (i + j == 4) { set colorbox user origin 0.88,0.15 size 0.015,0.7 } else { unset colorbox }
  set title names[i] . ', ' . sides[j]
  splot out . '/' . methods[i] . '_' . models[j] . '.dat' using 1:2:3 with pm3d
} }
