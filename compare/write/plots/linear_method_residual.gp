unset key
set xlabel 'Poisson ratio ν'
set ylabel '‖K_{FEM} − K_{MSM}‖_F / (E L_0)'
plot 'linear_method_residual.csv' using 1:2 with linespoints lt 2
