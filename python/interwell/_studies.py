"""The methods of a scene that ask studies, made of their declarations by a test."""

from __future__ import annotations

from typing import Any

from ._check import Over, Progress, _count, _real, _word
from ._table import Table


class Studies:
    """The studies of a scene."""

    __slots__ = ()

    def _ask(
        self,
        study: str,
        parts: str,
        over: Over | None,
        threads: int | None,
        progress: Progress,
        arguments: dict[str, Any],
        cells: bool,
    ) -> Table:
        raise NotImplementedError

    def escape(
        self,
        over: Over | None = None,
        *,
        runs: int = 100,
        within: float | None = None,
        until: str = "well",
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """How often a motion under noise leaves its well, and after which time.

        Runs that differ in the seed of the noise, for one scene or in every cell of a grid.

        Parameters
        ----------
        over : mapping of str to array_like of float, optional
            Fields and their values: a row for each cell.
        runs : int, default 100
            Runs of each cell, each with another seed of the noise, 1 to 1000000.
        within : float, optional
            Time in s at which a run without an escape ends; by default the duration of the scene's run.
        until : str, default "well"
            What counts as an escape. ``"crossing"``: The mass first crosses the top of the barrier. In half
            of these crossings under strong damping it falls back. ``"well"``: The mass first reaches the well
            behind the barrier: its equilibrium or, if a stop stands before that, the middle between the
            barrier and the stop.
        threads, progress
            See :meth:`sweep`.

        Returns
        -------
        Table or Grid
            ``runs``, ``escaped``, ``ended_early``, ``observed_s``, ``escape_rate_per_s``,
            ``escape_rate_low_per_s``, ``escape_rate_high_per_s``, ``mean_first_passage_s``,
            ``mean_first_passage_low_s``, ``mean_first_passage_high_s``, ``median_first_passage_s``,
            ``kramers_rate_per_s``, ``kramers_fails``; a :class:`Grid` with ``over``.

        Notes
        -----
        The rate is the number of escapes over the time observed in all runs, those without an escape
        included, which is the estimate of largest likelihood for exponential waiting times; its interval is
        that of chi-squared quantiles (Garwood 1936; Epstein and Sobel 1953; Cox 1953). The median is that of
        Kaplan and Meier (1958). Run number i, from 0, has the seed of the scene plus i. The relative width of
        the interval falls with the square root of the number of escapes.

        Kramers' rate is (sqrt(g^2/4 + w_b^2) - g/2)/w_b * w_0/(2 pi) * exp(-E/k_B T) with the rates w_0 of
        the well and w_b of the barrier, g = c/m and the height E of the barrier over the well (Kramers 1940;
        Hänggi, Talkner and Borkovec 1990, equation 4.33), times a factor that leads over to weak damping
        (Mel'nikov and Meshkov 1986). Noise with the two-sided spectral density S = rms^2/(2 (high - low)) of
        the base acceleration acts as k_B T = m^2 S/(2 c). The rate is missing where it does not hold, and
        ``kramers_fails`` says why.

        Examples
        --------
        >>> noisy = scene.set(excitation="Noise(rms_g: 1, low_hz: 0.5, high_hz: 10, seed: 5)")
        >>> table = noisy.escape(runs=8, within=4)
        >>> bool(table["escape_rate_low_per_s"][0] <= table["escape_rate_high_per_s"][0])
        True
        """
        arguments = {
            "runs": _count("runs", runs),
            "within": _real("within", within),
            "until": _word("until", until, ("crossing", "well")),
        }
        return self._ask("escape", "runs", over, threads, progress, arguments, True)

    def exponents(
        self,
        over: Over | None = None,
        *,
        periods: int = 1000,
        until_settled: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """Lyapunov exponents of the settled motion, with their standard errors, sum and dimension.

        The rates in 1/s at which small perturbations grow or decay.

        Parameters
        ----------
        over : mapping of str to array_like of float, optional
            Fields and their values: a row for each cell.
        periods : int, default 1000
            Forcing periods over which a motion that does not repeat is averaged, 1 to 10000000; without a
            drive periods of small oscillations.
        until_settled : float, optional
            Follow the motion, window after window, until it repeats, or up to this time in s, before anything
            is averaged; by default 1000 forcing periods after the scene's run.
        threads, progress
            See :meth:`sweep`.

        Returns
        -------
        Table or Grid
            The columns of docs/output.md; a :class:`Grid` with ``over``.

        Notes
        -----
        Of a motion that repeats, ln|multiplier| over its period; otherwise averages over ``periods``, 1 to
        1e7 (Benettin et al. 1980), through impacts by saltation (Müller 1995), with standard errors by batch
        means (Flegal and Jones 2010). More periods cost more and reduce these errors.

        Examples
        --------
        >>> weak = scene.set(stops="None", excitation={"amplitude_g": 0.2})
        >>> weak.exponents()["sum_per_s"].round(3)
        array([-3.337])
        """
        arguments = {
            "periods": _count("periods", periods),
            "until_settled": _real("until_settled", until_settled),
        }
        return self._ask("exponents", "cells", over, threads, progress, arguments, True)

    def section(
        self,
        over: Over | None = None,
        *,
        at: str = "phase",
        phase_deg: float | None = None,
        carry: str | None = None,
        skip: int | None = None,
        keep: int | None = None,
        until_settled: float | None = None,
        threads: int | None = None,
        progress: Progress = False,
    ) -> Table:
        """The state once a forcing period or at every impact; over a field the bifurcation diagram.

        Parameters
        ----------
        over : mapping of str to array_like of float, optional
            Fields and their values: a row for each cell.
        at : str, default "phase"
            A row once a forcing period, or at each impact of the settled window that counts. ``"phase"``: The
            state at one phase of each forcing period. ``"impacts"``: The impacts that count.
        phase_deg : float, optional
            The drive's phase in degrees at which the states are; by default 0.
        carry : str, optional
            Walk the last field in its order (up), backwards (down) or both ways: each run from the end of the
            one before, only the first from the scene's start. ``"up"``: In the order of its values.
            ``"down"``: Backwards. ``"both"``: Both, as two separate walks.
        skip : int, optional
            Forcing periods to skip, in place of run.settle_s; needs those to keep.
        keep : int, optional
            Forcing periods of the settled window after the skipped ones, in place of run.duration_s.
        until_settled : float, optional
            Follow each run, window after window, until its motion repeats, or up to this time in s.
        threads, progress
            See :meth:`sweep`.

        Returns
        -------
        Table
            The columns of docs/output.md.

        Notes
        -----
        The states are a section of Poincaré, taken from the polynomials of the integrator. The more periods
        are skipped, the fewer rows belong to a transient. The cost is that of the forcing periods that are
        run. Motions that begin to graze a stop have bifurcations of their own (Nordmark 1991).

        Examples
        --------
        >>> scene.section().rows
        15
        """
        arguments = {
            "at": _word("at", at, ("phase", "impacts")),
            "phase_deg": _real("phase_deg", phase_deg),
            "carry": _word("carry", carry, ("up", "down", "both")),
            "skip": _count("skip", skip),
            "keep": _count("keep", keep),
            "until_settled": _real("until_settled", until_settled),
        }
        return self._ask("section", "runs", over, threads, progress, arguments, False)

    def spectrum(
        self,
        of: str = "x",
        *,
        taper: str = "auto",
        rate_hz: float | None = None,
        until_settled: float | None = None,
    ) -> Table:
        """Amplitude and power spectral density of the settled motion over frequency.

        Parameters
        ----------
        of : str, default "x"
            Signal. ``"x"``: Displacement relative to the base, m. ``"v"``: Velocity relative to the base,
            m/s. ``"accel"``: Acceleration of the base, m/s^2.
        taper : str, default "auto"
            Weights of the samples. ``"auto"``: None where the motion repeats, whose samples are whole periods
            of it so that its lines are exact, and those of von Hann elsewhere. ``"hann"``: Those of von Hann.
            ``"none"``: None.
        rate_hz : float, optional
            Samples a second, increased until a forcing period has a whole number of them; by default 128 or
            more in the shortest period of excitation and mechanism.
        until_settled : float, optional
            Follow the motion, window after window, until it repeats, or up to this time in s; the spectrum is
            of the last window. Needs a drive that repeats.

        Returns
        -------
        Table
            The columns of docs/output.md.

        Notes
        -----
        The settled window is sampled evenly, over whole periods where the drive repeats. Where the motion
        repeats too, its lines are exact and no window function is needed; otherwise that of von Hann is
        taken, and amplitude and density are scaled as in Heinzel et al. (2002). Components above half the
        rate fold back: a higher ``rate_hz`` reduces this, which matters with impacts. Two runs are made, one
        for the verdict and one for the samples.

        Examples
        --------
        >>> table = scene.spectrum("accel")
        >>> table["amplitude"][table["frequency_hz"] == 3.0].round(6)
        array([14.709975])
        """
        arguments = {
            "of": _word("of", of, ("x", "v", "accel")),
            "taper": _word("taper", taper, ("auto", "hann", "none")),
            "rate_hz": _real("rate_hz", rate_hz),
            "until_settled": _real("until_settled", until_settled),
        }
        return self._ask("spectrum", "runs", None, None, False, arguments, True)
