set multiplot layout 2,1
set key off
set xlabel 'mode'
set ylabel 'eigenvalue, msm/fem'
plot data using 1:4 with linespoints lt 2
set ylabel 'angle, degrees'
plot data using 1:5 with linespoints lt 2
unset multiplot
