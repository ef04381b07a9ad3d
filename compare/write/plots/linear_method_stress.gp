# Close to incompressibility the cell is ten times too stiff: the others are seen in the enlarged panel alone.
data = 'linear_method_curves.csv'
set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#aacd28') # viridis without its yellow, lost on paper
unset colorbox
set multiplot layout 1,2
set xlabel 'axial engineering strain'
set xrange [0:0.1]
set ylabel 'engineering stress / E'
do for [panel=1:2] {
  if (panel == 1) {
    unset key
    set yrange [0:1]
  } else {
    set key outside right
    set title 'enlarged'
    set yrange [0:0.14]
  }
  plot for [i=1:|ratios|] data index i-1 using 2:3 with linespoints lw 1.5 dt solid pt i pi 4 \
    lc palette frac (i-1.0)/(|ratios|-1) title sprintf('ν = %g', ratios[i]), x lt 1 lw 3 dt (8,6) title 'finite element'
}
unset multiplot
