# What every figure has: formats, and eight linetypes in the colours of Okabe and Ito (2008), which the colour-blind tell apart,
# each with its own dashes and marker, so that a figure survives a black-and-white printer. The finite elements (or the
# reference) are linetype 1 and the springs linetype 2 everywhere.
reset
if (!exists('part')) part = '' # ending of the pictures' names while they are drawn
set encoding utf8
set datafile separator ','
data = name.'.csv'
if (format eq 'svg') {
  set terminal svg enhanced background 'white' size width,height font 'Sans,12'
} else {
  set terminal pngcairo enhanced size width,height font 'Sans,12'
}
set output name.'.'.format.part
set linetype 1 lc rgb '#0072B2' lw 2 dt solid pt 7
set linetype 2 lc rgb '#D55E00' lw 2 dt (12,5) pt 5
set linetype 3 lc rgb '#009E73' lw 2 dt (3,4) pt 9
set linetype 4 lc rgb '#CC79A7' lw 2 dt (12,4,3,4) pt 13
set linetype 5 lc rgb '#E69F00' lw 2 dt (20,5) pt 11
set linetype 6 lc rgb '#56B4E9' lw 2 dt (6,6) pt 4
set linetype 7 lc rgb '#000000' lw 2 dt (3,8) pt 6
set linetype 8 lc rgb '#777777' lw 2 dt (20,4,3,4,3,4) pt 8
set linetype cycle 8
set border 3 lc rgb '#333333'
set tics nomirror
set grid lc rgb '#dddddd' lt 1 lw 0.5 dt solid
set key Left reverse samplen 4 spacing 1.2
