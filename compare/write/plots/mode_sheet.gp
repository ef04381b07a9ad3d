# The shapes of the eigenspaces from the second on; the first is the rigid motions.
unset border
unset tics
unset key
unset grid
set view 65,25
set view equal xyz
set multiplot layout (|titles|+2)/3,3
do for [i=1:|titles|] {
  set title titles[i]
  splot sprintf('%s_%d.csv', name, i+1) using 1:2:3 with lines lt 8 lw 1 dt solid, '' using 4:5:6 with lines lt 2 dt solid
}
unset multiplot
