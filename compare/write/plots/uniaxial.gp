set multiplot layout 1,2
set key left top
set xlabel 'axial logarithmic strain'
set ylabel 'Cauchy stress, MPa'
plot data using 1:2 with lines lt 1 title 'reference', '' using 1:3 with linespoints lt 2 title 'mass-spring cell'
set key right top
set ylabel 'lateral logarithmic strain'
plot data using 1:4 with lines lt 1 title 'reference', '' using 1:5 with linespoints lt 2 title 'mass-spring cell'
unset multiplot
