set datafile missing '?'
set title sprintf('log_{10} φ; condition number %.3g', condition)
set xlabel labels[1]
set ylabel labels[2]
set view map
set border 15
unset grid
set contour base
set cntrparam levels 12
unset key
set pm3d map
set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')
splot data using 1:2:(log10($3)) with pm3d nocontour, '' using 1:2:(log10($3)) with lines nosurface lc rgb '#555555', \
  'valley_sets.csv' using 1:2:(log10($3)) with points pt 7 ps 1.2 lc rgb 'black' nocontour
