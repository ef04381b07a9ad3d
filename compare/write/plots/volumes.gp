set xrange [0.4:|labels|+0.6]
set bmargin 3.5
set ylabel 'volume of a cell, mm^3'
unset grid
set grid ytics
set key outside top center horizontal
set boxwidth 0.4
label(i) = word(labels[i], 1)."\n".word(labels[i], 2)
plot data index 0 using 1:4:3:7:6:xtic(label(int($1))) with candlesticks whiskerbars 0.5 lt 1 lw 1.5 fc rgb '#dcecf6' \
    fs solid border lc rgb '#0072B2' title 'quartiles; whiskers within 1.5 interquartile ranges', \
  '' index 0 using 1:5:5:5:5 with candlesticks lt 2 lw 3 dt solid title 'median', \
  '' index 1 using 1:2 with points pt 1 lc rgb '#D55E00' title 'outliers', \
  rest with lines lt 7 lw 1 title 'at rest'
