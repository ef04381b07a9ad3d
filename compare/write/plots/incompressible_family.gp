set multiplot layout 1,2 title sprintf('%d sets of stiffnesses', n_sets)
set xlabel 'axial logarithmic strain'
set ylabel 'Cauchy stress, MPa'
unset key
plot data using 4:5 with lines lt 2 lw 0.7 dt solid
set ylabel 'lateral logarithmic strain'
set key right top
plot data using 4:6 with lines lt 2 lw 0.7 dt solid title 'mass-spring cells', -x/2 lt 1 lw 3 dt (8,6) title 'incompressible'
unset multiplot
