"""Laws of make_truths.py: first Piola-Kirchhoff stress and energy of displacement gradients H[..., i, J], as docs/reference/case-file.md states them."""

import numpy as np


def lame(material):
    e, nu = material["youngs_modulus"], material["poissons_ratio"]
    return e * nu / (1 + nu) / (1 - 2 * nu), e / 2 / (1 + nu)


class SmallStrain:
    linear = True

    def __init__(self, material):
        self.first, self.mu = lame(material)

    def stress(self, h):
        strain = (h + np.swapaxes(h, -1, -2)) / 2
        return self.first * np.trace(strain, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) + 2 * self.mu * strain

    def energy(self, h):
        return (self.stress(h) * h).sum((-1, -2)) / 2


class SaintVenantKirchhoff:
    linear = False

    def __init__(self, material):
        self.small = SmallStrain(material)

    @staticmethod
    def strain(h):
        return (h + np.swapaxes(h, -1, -2) + np.swapaxes(h, -1, -2) @ h) / 2

    def stress(self, h):
        return (h + np.eye(3)) @ self.small.stress(self.strain(h))

    def energy(self, h):
        return self.small.energy(self.strain(h))


class Principal:
    """A law of the logarithms of the principal stretches: the subclass has principal Kirchhoff stresses."""

    linear = False

    def logarithms(self, f):
        squares, directions = np.linalg.eigh(f @ np.swapaxes(f, -1, -2))
        return np.log(squares) / 2, directions

    def stress(self, h):
        f = h + np.eye(3)
        x, directions = self.logarithms(f)
        kirchhoff = (directions * self.kirchhoff(x)[..., None, :]) @ np.swapaxes(directions, -1, -2)
        return kirchhoff @ np.swapaxes(np.linalg.inv(f), -1, -2)

    def energy(self, h):
        return self.energy_of(self.logarithms(h + np.eye(3))[0])


class LogStrain(Principal):
    """Hooke's law between the Cauchy stress and ln V; the energy is the work on the straight path of ln V."""

    def __init__(self, material):
        self.first, self.mu = lame(material)

    def kirchhoff(self, x):
        volume = x.sum(-1, keepdims=True)
        return np.exp(volume) * (self.first * volume + 2 * self.mu * x)

    def energy_of(self, x):
        t = x.sum(-1)
        small = np.abs(t) < 1e-3
        safe = np.where(small, 1, t)
        # the integral of s exp(s t) over 0 < s < 1
        weight = np.where(small, 0.5 + t / 3 + t * t / 8, (np.exp(safe) * (safe - 1) + 1) / safe**2)
        return weight * (self.first * t * t + 2 * self.mu * (x * x).sum(-1))


class Ogden(Principal):
    def __init__(self, material):
        self.terms = list(zip(material["mu"], material["alpha"]))
        self.kappa = material.get("bulk_modulus", 1000 * sum(material["mu"]))

    def kirchhoff(self, x):
        volume = x.sum(-1, keepdims=True)
        total = self.kappa / 2 * (np.exp(2 * volume) - 1) + 0 * x
        for mu, alpha in self.terms:
            power = np.exp(alpha * (x - volume / 3))
            total = total + 2 * mu / alpha * (power - power.mean(-1, keepdims=True))
        return total

    def energy_of(self, x):
        volume = x.sum(-1)
        total = self.kappa / 4 * (np.exp(2 * volume) - 1 - 2 * volume)
        for mu, alpha in self.terms:
            total = total + 2 * mu / alpha**2 * (np.exp(alpha * (x - volume[..., None] / 3)).sum(-1) - 3)
        return total


LAWS = {"small_strain": SmallStrain, "log_strain": LogStrain, "saint_venant_kirchhoff": SaintVenantKirchhoff, "hyperelastic": Ogden}
