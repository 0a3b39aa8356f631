"""Estimators of velocity from places at uneven times. Each sees the past only and gives the velocity of the newest
place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# [n] seconds and [n, 3] metres to [n, 3] m/s
Estimator = Callable[[Array, Array], Array]


def tracker_noise(times: Array, places: Array, *, first=0.00005, least=0.000005, most=0.0005, quantile=0.35, gain=0.2) -> Array:
    """[n] metres on each axis"""
    found = np.empty(len(times))
    level = first
    # chi with 3 degrees of freedom
    from scipy.stats import chi
    unit = chi(3).ppf(quantile)
    for newest in range(len(times)):
        if newest >= 3:
            t = times[newest - 3 : newest + 1]
            weights = np.array([1.0 / np.prod(t[i] - np.delete(t, i)) for i in range(4)])
            residual = np.linalg.norm(weights @ places[newest - 3 : newest + 1]) / np.linalg.norm(weights)
            level *= 1.0 + gain * quantile if residual > unit * level else 1.0 - gain * (1.0 - quantile)
            level = min(max(level, least), most)
        found[newest] = level
    return found


def _windows(times, places, length):
    n = len(times)
    index = np.arange(n)[:, None] - np.arange(length)
    known = index >= 0
    index = np.maximum(index, 0)
    return times[index] - times[:, None], places[index] - places[:, None, :], known


def wald(times, places, window=0.035):
    out = np.zeros_like(places)
    for newest in range(1, len(times)):
        count = 1
        while count <= newest and (count < 2 or times[newest] - times[newest - count] <= window or (count < 3 and times[newest] - times[newest - count] <= 3 * window)):
            count += 1
        half = count // 2
        new = slice(newest - half + 1, newest + 1)
        old = slice(newest - count + 1, newest - count + 1 + half)
        out[newest] = (places[new].sum(0) - places[old].sum(0)) / (times[new].sum() - times[old].sum())
    return out


def _fit(tau, y, order):
    """tau [n,m], y [n,m,3] -> slope b1, curvature b2, p1end, alpha, Q, p1, p2, mean"""
    m = tau.shape[1]
    p1 = tau - tau.mean(1, keepdims=True)
    M2 = (p1**2).sum(1)
    mean = y.mean(1)
    b1 = np.einsum("nm,nmd->nd", p1, y) / M2[:, None]
    if m < 3 or order < 2:
        z = np.zeros(len(tau))
        return mean, b1, np.zeros_like(b1), p1, np.zeros_like(p1), z, z + 1.0
    a = (p1**3).sum(1) / M2
    p2 = p1**2 - a[:, None] * p1 - (M2 / m)[:, None]
    Q = (p2**2).sum(1)
    b2 = np.einsum("nm,nmd->nd", p2, y) / Q[:, None]
    return mean, b1, b2, p1, p2, 2 * p1[:, 0] - a, Q


def adaptive(times, places, *, order=2, band=2.5, seconds=0.1, least=3, shrink=0.0, most=64, noise=None, line_tests=False, grow=8, **kw):
    sigma = tracker_noise(times, places, **kw) if noise is None else np.full(len(times), noise)
    tau, y, known = _windows(times, places, most)
    out = np.zeros_like(places)
    open_ = known[:, 1].copy()
    count = 2
    while count <= most:
        t, p = tau[:, :count], y[:, :count]
        ok = open_ & known[:, count - 1] & ((tau[:, count - 1] >= -seconds) | (count <= least))
        if not ok.any():
            break
        mean, b1, b2, p1, p2, d2, Q = _fit(t[ok], p[ok], order)
        w = np.ones(len(Q))
        if shrink > 0 and order == 2 and count >= 3:
            explained = (b2**2).sum(1) * Q
            w = np.clip(1 - shrink * sigma[ok] ** 2 / np.maximum(explained, 1e-30), 0, 1)
        wt = w if line_tests else np.ones(len(Q))
        r = p[ok] - mean[:, None] - p1[..., None] * b1[:, None] - (wt[:, None] * p2)[..., None] * b2[:, None]
        worst = np.sqrt((r**2).sum(2)).max(1)
        good = (worst <= band * sigma[ok]) | (count <= least)
        rows = np.flatnonzero(ok)
        open_[:] = False
        open_[rows[good]] = True
        v = b1 + (w * d2)[:, None] * b2
        out[rows[good]] = v[good]
        count += max(1, count // grow)
    return out


def end_of_parabola(times, places, seconds=0.05, least=4):
    return adaptive(times, places, band=1e9, seconds=seconds, least=least, noise=1.0)


def kalman(times, places, jerk=50.0, **kw):
    sigma = tracker_noise(times, places, **kw)
    n = len(times)
    out = np.zeros_like(places)
    x = np.zeros((3, 3)); x[0] = places[0]
    P = np.diag([1e-6, 1.0, 100.0])
    for i in range(1, n):
        T = times[i] - times[i - 1]
        F = np.array([[1, T, T * T / 2], [0, 1, T], [0, 0, 1]])
        Q = jerk**2 * np.array([[T**5 / 20, T**4 / 8, T**3 / 6], [T**4 / 8, T**3 / 3, T**2 / 2], [T**3 / 6, T**2 / 2, T]])
        x = F @ x
        P = F @ P @ F.T + Q
        S = P[0, 0] + sigma[i] ** 2
        K = P[:, 0] / S
        x = x + np.outer(K, places[i] - x[0])
        P = P - np.outer(K, P[0])
        out[i] = x[1]
    return out
