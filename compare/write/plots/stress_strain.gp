# A block of data for the material and one for every design, of either test.
set linetype 9 lc rgb '#8B0000' lw 1 dt solid
linetype(i) = 1 + (i - 1) % 9
set multiplot layout 1,2
set key left top noenhanced
set xlabel 'axial logarithmic strain'
set ylabel 'nominal stress over Young''s modulus'
set title 'uniaxial, free sides'
plot name.'_uniaxial.csv' index 0 using 2:3 with lines lw 4 lc rgb '#bbbbbb' dt solid title 'material', \
  for [i=1:|designs|] '' index i using 2:3 with lines lt linetype(i) title designs[i]
set nokey
set xlabel 'amount of shear'
set title 'simple shear'
plot name.'_shear.csv' index 0 using 2:3 with lines lw 4 lc rgb '#bbbbbb' dt solid notitle, \
  for [i=1:|designs|] '' index i using 2:3 with lines lt linetype(i) notitle
unset multiplot
