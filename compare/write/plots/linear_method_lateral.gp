data = 'linear_method_curves.csv'
set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#aacd28')
unset colorbox
set key outside right
set xlabel 'axial engineering strain'
set xrange [0:0.1]
set ylabel 'lateral engineering strain (dashed: finite element)'
colour(i) = (i-1.0)/(|ratios|-1)
plot for [i=1:|ratios|] data index i-1 using 2:4 with linespoints lw 1.5 dt solid pt i pi 4 lc palette frac colour(i) \
    title sprintf('ν = %g', ratios[i]), \
  for [i=1:|ratios|] -ratios[i]*x dt 2 lc palette frac colour(i) notitle
