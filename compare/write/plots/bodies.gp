# Three blocks of data a panel, all in one window so that they have one scale: finite elements, springs, body at rest.
gap = 75.0/width
set multiplot layout rows,columns margins screen gap,1 - 10.0/width,135.0/height,1 - 40.0/height spacing screen gap,100.0/height
set datafile missing '?'
unset grid
set size ratio -1
set xlabel 'across, mm'
set ylabel 'up, mm'
set xrange [left:right]
set yrange [bottom:top]
set key noautotitle at screen 0.5,screen 8.0/height center bottom
do for [i=1:|titles|] {
  set title titles[i] noenhanced
  if (i > 1) { unset key }
  plot data index 3*i-3 using 4:5 with filledcurves closed fc rgb '#dcecf6' fs solid border lt 1 lw 0.8, \
    '' index 3*i-2 using 4:5 with lines lt 2 lw 1 dt solid, '' index 3*i-1 using 4:5 with lines lt 7 lw 0.8, \
    1/0 with lines lt 1 title 'finite elements', 1/0 with lines lt 2 dt solid title 'springs', \
    1/0 with lines lt 7 lw 1 title 'at rest'
}
unset multiplot
