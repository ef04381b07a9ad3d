# One Ogden term to the measured curve: gnuplot fit.gp prints mu (kPa) and alpha.
set datafile separator ","
nominal(l) = 2 * mu / alpha * (l**(alpha - 1) - l**(-alpha / 2 - 1))
mu = 1; alpha = -10
set fit quiet
set fit logfile "/dev/null"
fit nominal(x) "measured.csv" using 1:2 via mu, alpha
print sprintf("mu = %.4g kPa, alpha = %.4g, root mean square of the residuals %.3g kPa", mu, alpha, sqrt(FIT_WSSR / FIT_NDF))
