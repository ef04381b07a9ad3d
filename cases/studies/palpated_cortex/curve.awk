# Stretch and nominal stress (kPa) to what `springproof design --curve` reads: logarithmic strain, Cauchy stress (MPa). The
# tissue is taken as incompressible, so Cauchy = nominal * stretch.
# awk -F, -f curve.awk measured.csv > curve.csv
/^#/ { next }
{ printf "%.6f,%.6e\n", log($1), $2 * $1 / 1000 }
