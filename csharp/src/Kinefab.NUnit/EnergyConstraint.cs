using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Validation;
using NUnit.Framework.Constraints;

namespace Kinefab.NUnit;

/// <summary>
/// Kinetic and potential energy together stay what they were while the scene moves by itself. Drives, motors, springs and
/// damping give and take energy: it is for scenes without. A failure shows the energy over time.
/// </summary>
public sealed class EnergyConstraint : Constraint
{
    // Share of the energy at the start that a scene at rest may lose to rounding.
    private const double Rounding = 1e-9;

    private double _tolerance = 0.1;
    private bool _isPercent;
    private double _seconds = 1;
    private SolverKind _solver = SolverKind.Exact;

    internal EnergyConstraint()
    {
    }

    /// <inheritdoc/>
    public override string Description => string.Create(
        CultureInfo.InvariantCulture,
        $"energy kept within {_tolerance} {(_isPercent ? "% of the largest kinetic energy" : "J")} for {_seconds} s by the {(_solver == SolverKind.Exact ? "exact" : "unity")} solver");

    /// <summary>Of the largest kinetic energy that the scene has meanwhile.</summary>
    public EnergyConstraint Percent
    {
        get
        {
            _isPercent = true;
            return this;
        }
    }

    /// <summary>How much it may change: joules, or percent with <see cref="Percent"/> behind it; 0.1 unless stated.</summary>
    /// <param name="tolerance">Joules or percent, not negative.</param>
    /// <returns>This constraint, to go on with.</returns>
    public EnergyConstraint Within(double tolerance)
    {
        _tolerance = tolerance >= 0 ? tolerance : throw Figures.Negative(nameof(tolerance), tolerance);
        return this;
    }

    /// <summary>How long, seconds; 1 unless stated.</summary>
    /// <param name="seconds">More than 0.</param>
    /// <returns>This constraint, to go on with.</returns>
    public EnergyConstraint For(double seconds)
    {
        _seconds = seconds > 0 && double.IsFinite(seconds) ? seconds : throw new ArgumentOutOfRangeException(nameof(seconds), seconds, "How long it runs is a finite number of seconds above 0.");
        return this;
    }

    /// <summary>Which solver moves it; the exact one unless stated. Unity's own loses energy by its method.</summary>
    /// <param name="solver">Unity's or the exact one.</param>
    /// <returns>This constraint, to go on with.</returns>
    public EnergyConstraint By(SolverKind solver)
    {
        _solver = solver;
        return this;
    }

    /// <inheritdoc/>
    public override ConstraintResult ApplyTo<TActual>(TActual actual) => FaultyFile.OrResult(this, actual, () => Judge(actual));

    private MechanismResult Judge(object? actual)
    {
        ValidScene scene = Tested.Scene(actual);
        World world = World.Create(scene, _solver);
        double step = scene.Document.Physics.FixedTimestep;
        int steps = (int)Math.Ceiling(_seconds / step - 1e-9);
        double start = world.KineticEnergy + world.PotentialEnergy;
        double most = world.KineticEnergy;
        var series = new List<(double Time, double Energy)> { (0, start) };
        for (int i = 0; i < steps && world.Stops == 0; i++)
        {
            world.Step(step);
            most = Math.Max(most, world.KineticEnergy);
            series.Add((world.Time, world.KineticEnergy + world.PotentialEnergy));
        }

        double allowed = (_isPercent ? _tolerance / 100 * most : _tolerance) + Rounding * Math.Abs(start);
        (double time, double energy) = series.MaxBy(sample => Math.Abs(sample.Energy - start));
        string found = world.Stops > 0 ? $"the solver stopped a motion at {Figures.Number(world.Time)} s"
            : Math.Abs(energy - start) <= allowed ? ""
            : $"{Figures.Number(energy - start)} J more after {Figures.Number(time)} s, {Figures.Number(most)} J being the largest kinetic energy";
        List<string>? lines = found.Length == 0 ? null : Lines(world, series);
        return new MechanismResult(this, actual, lines is null, found, lines);
    }

    private static List<string> Lines(World world, List<(double Time, double Energy)> series)
    {
        var lines = new List<string> { "time [s]  energy [J]" };
        lines.AddRange(Figures.Rows(series.Count).Select(i => $"{Figures.Number(series[i].Time)}  {series[i].Energy.ToString("G9", CultureInfo.InvariantCulture)}"));
        lines.AddRange(world.Findings.Diagnostics.Select(finding => $"{finding.Code}: {finding.Message}"));
        return lines;
    }
}
