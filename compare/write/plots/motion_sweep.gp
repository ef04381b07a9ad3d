# A block of data for each method and step, coarse to fine meshes.
set title headline noenhanced
set logscale xy
set xlabel 'computing for a second of motion, s'
set ylabel 'error, %'
set key outside right noenhanced
set format x '%g'
set format y '%g'
set arrow from first 1, graph 0 to first 1, graph 1 nohead lc rgb '#777777' dt 2
set label 'real time' at first 1, graph 0.02 rotate by 90 left offset -0.5,0 tc rgb '#777777'
plot for [i=1:|lines|] points index i-1 using 1:2 with linespoints lt linetypes[i] pt markers[i] title lines[i], \
  uncertainty with lines lc rgb '#777777' dt 3 title 'uncertainty of the reference'
