# gnuplot worst_error.gp draws worst_error.svg, the README's picture, from worst_error.csv.
set encoding utf8
set datafile separator ','
set datafile missing ''
set terminal svg size 720,400 font 'Sans,13' background 'white'
set linetype 1 lc rgb '#0072B2' lw 2 dt solid pt 7
set linetype 2 lc rgb '#D55E00' lw 2 dt (12,5) pt 5
set linetype 3 lc rgb '#009E73' lw 2 dt (3,4) pt 9
set linetype 4 lc rgb '#CC79A7' lw 2 dt (12,4,3,4) pt 13
set linetype 5 lc rgb '#E69F00' lw 2 dt (20,5) pt 11
set border 3 lc rgb '#333333'
set tics nomirror
set grid lc rgb '#dddddd' lt 1 lw 0.5 dt solid
set key outside right center Left reverse samplen 4 spacing 1.4
set output 'worst_error.svg'
set logscale y
set yrange [1:100]
set xrange [0.24:0.5]
set xlabel 'Poisson''s ratio of the tissue'
set ylabel 'worst error of the springs, %'
plot 'worst_error.csv' using 1:2 with linespoints lt 2 title 'linear method (thesis, ch. 4)', \
     '' using 1:($3 > 0 ? $3 : NaN) with linespoints lt 4 title 'nonlinear method (ch. 5)', \
     '' using 1:4 with linespoints lt 3 title 'moduli: springs alone', \
     '' using 1:6 with linespoints lt 5 title 'multi-load fit', \
     '' using 1:5 with linespoints lt 1 title 'hybrid: springs and cell volume'
unset output
