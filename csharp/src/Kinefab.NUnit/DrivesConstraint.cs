using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Kinematics;
using NUnit.Framework.Constraints;

namespace Kinefab.NUnit;

/// <summary>
/// A coordinate can be driven through a range at position level, and others move by their strokes meanwhile. Angles in
/// degrees, lengths in metres, from the exported pose. A failure shows where the drive stops and the series.
/// </summary>
public sealed class DrivesConstraint : Constraint
{
    private readonly string _driven;
    private readonly List<(string Name, double Stroke)> _followers = [];
    private double _from;
    private double _to = 360;
    private int _steps = 72;
    private double _tolerance = 1e-6;

    internal DrivesConstraint(string driven) => _driven = driven ?? throw new ArgumentNullException(nameof(driven));

    /// <inheritdoc/>
    public override string Description => string.Create(
        CultureInfo.InvariantCulture,
        $"{_driven} goes from {_from} to {_to}{string.Concat(_followers.Select(f => $" and moves {f.Name} by {Figures.Number(f.Stroke)} within {Figures.Number(_tolerance)}"))}");

    /// <summary>Where the drive begins; the exported pose (0) unless stated.</summary>
    /// <param name="value">Degrees or metres, 0 at the exported pose.</param>
    /// <returns>This constraint, to go on with.</returns>
    public DrivesConstraint From(double value)
    {
        _from = value;
        return this;
    }

    /// <summary>Where it ends; a whole turn (360) unless stated.</summary>
    /// <param name="value">Degrees or metres, 0 at the exported pose.</param>
    /// <returns>This constraint, to go on with.</returns>
    public DrivesConstraint To(double value)
    {
        _to = value;
        return this;
    }

    /// <summary>Equal steps on the way; 72 unless stated.</summary>
    /// <param name="steps">1 or more.</param>
    /// <returns>This constraint, to go on with.</returns>
    public DrivesConstraint Steps(int steps)
    {
        _steps = steps > 0 ? steps : throw new ArgumentOutOfRangeException(nameof(steps), steps, "It takes 1 step or more.");
        return this;
    }

    /// <summary>Another coordinate that moves meanwhile.</summary>
    /// <param name="coordinate">Named as the driven one is.</param>
    /// <returns>The follower, whose stroke <see cref="Follower.By"/> states.</returns>
    public Follower Moving(string coordinate) => new(this, coordinate ?? throw new ArgumentNullException(nameof(coordinate)));

    /// <summary>How far strokes may be off, degrees or metres; 1e-6 unless stated.</summary>
    /// <param name="tolerance">Degrees or metres, not negative.</param>
    /// <returns>This constraint, to go on with.</returns>
    public DrivesConstraint Within(double tolerance)
    {
        _tolerance = tolerance >= 0 ? tolerance : throw Figures.Negative(nameof(tolerance), tolerance);
        return this;
    }

    /// <inheritdoc/>
    public override ConstraintResult ApplyTo<TActual>(TActual actual) => FaultyFile.OrResult(this, actual, () => Judge(actual));

    private MechanismResult Judge(object? actual)
    {
        Mechanism mechanism = Tested.Mechanism(actual);
        int driven = mechanism.CoordinateNamed(_driven);
        int[] followers = _followers.Select(f => mechanism.CoordinateNamed(f.Name)).ToArray();
        SweepResult sweep = new Sweep(new PositionSolver(mechanism)).Run(mechanism.NewState(), driven, _from, _to, _steps);
        string found = Found(mechanism, sweep, driven, followers);
        return new MechanismResult(this, actual, found.Length == 0, found, found.Length == 0 ? null : Series(mechanism, sweep, driven, followers));
    }

    // Empty: as expected.
    private string Found(Mechanism mechanism, SweepResult sweep, int driven, int[] followers)
    {
        MechanismCoordinate coordinate = mechanism.Coordinates[driven];
        if (sweep.Stop is RangeLimit stop)
        {
            string why = stop.End switch
            {
                RangeEnd.Limit when stop.Limit is ReachedLimit limit =>
                    $"the {(limit.IsUpper ? "upper" : "lower")} limit of {mechanism.Scene.Document.GameObjects[limit.GameObject].Id}",
                RangeEnd.Fold => "a dead centre",
                RangeEnd.Bifurcation => "a pose at which branches of motion cross",
                _ => "no pose was found beyond",
            };
            return $"it stops at {Figures.Of(coordinate, stop.Value)}: {why}";
        }

        if (sweep.Jumps.Count > 0)
            return $"it comes to another branch of motion at {Figures.Of(coordinate, sweep.Jumps[0])}";
        for (int i = 0; i < followers.Length; i++)
        {
            double stroke = Stroke(sweep, followers[i]);
            if (!(Math.Abs(stroke - _followers[i].Stroke) <= _tolerance))
                return $"{mechanism.Coordinates[followers[i]].Name} moves by {Figures.Of(mechanism.Coordinates[followers[i]], stroke)}";
        }

        return "";
    }

    private static double Stroke(SweepResult sweep, int coordinate)
    {
        double[] values = sweep.States.Select(state => state.Coordinate(coordinate)).ToArray();
        return values.Max() - values.Min();
    }

    private static List<string> Series(Mechanism mechanism, SweepResult sweep, int driven, int[] followers)
    {
        int[] columns = [driven, .. followers];
        var lines = new List<string> { string.Join("  ", columns.Select(c => $"{mechanism.Coordinates[c].Name} [{Figures.UnitOf(mechanism.Coordinates[c])}]")) };
        lines.AddRange(Figures.Rows(sweep.States.Count).Select(i => string.Join("  ", columns.Select(c => Figures.Number(sweep.States[i].Coordinate(c))))));
        return lines;
    }

    /// <summary>A coordinate that moves while another is driven.</summary>
    public readonly struct Follower
    {
        private readonly DrivesConstraint _constraint;
        private readonly string _name;

        internal Follower(DrivesConstraint constraint, string name)
        {
            _constraint = constraint;
            _name = name;
        }

        /// <summary>Its stroke: the largest of its values less the least, degrees or metres.</summary>
        /// <param name="stroke">Degrees or metres, not negative.</param>
        /// <returns>The constraint, to go on with.</returns>
        public DrivesConstraint By(double stroke)
        {
            _constraint._followers.Add((_name, stroke));
            return _constraint;
        }
    }
}
