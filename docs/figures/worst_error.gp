# gnuplot worst_error.gp draws worst_error.svg, the README's picture, from worst_error.csv.
set encoding utf8
set datafile separator ','
set datafile missing ''
set terminal svg size 1080,420 font 'Sans,13' background 'white'
set linetype 1 lc rgb '#0072B2' lw 2 dt solid pt 7
set linetype 2 lc rgb '#D55E00' lw 2 dt (12,5) pt 5
set linetype 3 lc rgb '#009E73' lw 2 dt (3,4) pt 9
set linetype 4 lc rgb '#CC79A7' lw 2 dt (12,4,3,4) pt 13
set linetype 5 lc rgb '#E69F00' lw 2 dt (20,5) pt 11
set linetype 6 lc rgb '#56B4E9' lw 3 dt solid pt 13
set border 3 lc rgb '#333333'
set tics nomirror
set grid lc rgb '#dddddd' lt 1 lw 0.5 dt solid
set output 'worst_error.svg'
set logscale y
set yrange [1:100]
set xrange [0.24:0.5]
set xtics 0.1
set tmargin 2
set linetype 7 lc rgb '#888888' lw 1.5 dt solid pt 6
set linetype 8 lc rgb '#888888' lw 1.5 dt (12,5) pt 4
set linetype 9 lc rgb '#888888' lw 1.5 dt (3,4) pt 8
set linetype 10 lc rgb '#888888' lw 1.5 dt (12,4,3,4) pt 12
set linetype 11 lc rgb '#888888' lw 1.5 dt (20,5) pt 10
set linetype 12 lc rgb '#444444' lw 1.5 dt solid pt 1
set linetype 13 lc rgb '#000000' lw 2 dt solid pt 15
# In the order of the columns.
array titles = ['linear method (thesis, ch. 4)', 'nonlinear method (ch. 5)', 'moduli: springs alone', \
                'hybrid: springs and cell volume', 'matched: hybrid that softens', 'midline: right on coarse cells', 'multi-load fit', 'Ladd and Kinney', 'Baudet', \
                'uniform: one stiffness', 'Van Gelder', 'Lloyd', 'biquadratic (Delingette)']
array styles = [2, 4, 3, 1, 6, 13, 5, 7, 8, 12, 9, 10, 11]
n = |titles|
set multiplot
set xlabel 'Poisson''s ratio of the tissue'
set ylabel 'worst error of the springs, %'
set title 'small loads'
set nokey
set lmargin at screen 0.07
set rmargin at screen 0.32
plot for [d = 1:n] 'worst_error.csv' using 1:(column(d + 1) > 0 ? column(d + 1) : NaN) with linespoints lt styles[d] notitle
set ylabel ''
set title 'large loads'
set key at screen 0.67, 0.95 left top Left reverse samplen 3 spacing 1.15 maxrows 13 maxcols 1
set lmargin at screen 0.38
set rmargin at screen 0.64
plot for [d = 1:n] 'worst_error.csv' using 1:(column(d + 1 + n) > 0 ? column(d + 1 + n) : NaN) with linespoints lt styles[d] title titles[d]
unset multiplot
unset output
