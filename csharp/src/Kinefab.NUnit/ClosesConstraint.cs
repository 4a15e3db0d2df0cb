using System;
using Kinefab.Kinematics;
using NUnit.Framework.Constraints;

namespace Kinefab.NUnit;

/// <summary>All loops and couplings can be closed at the exported pose, or stayed closed in a sweep.</summary>
public sealed class ClosesConstraint : Constraint
{
    private double _tolerance = 1e-9;

    internal ClosesConstraint()
    {
    }

    /// <inheritdoc/>
    public override string Description => $"all joints closed within {Figures.Number(_tolerance)} m and radians";

    /// <summary>What may be left, metres and radians; 1e-9 unless stated.</summary>
    /// <param name="tolerance">Metres and radians, not negative.</param>
    /// <returns>This constraint, to go on with.</returns>
    public ClosesConstraint Within(double tolerance)
    {
        _tolerance = tolerance >= 0 ? tolerance : throw Figures.Negative(nameof(tolerance), tolerance);
        return this;
    }

    /// <inheritdoc/>
    public override ConstraintResult ApplyTo<TActual>(TActual actual) => FaultyFile.OrResult(this, actual, () => Judge(actual));

    private MechanismResult Judge(object? actual)
    {
        (double metres, double degrees) = actual is SweepResult sweep ? (sweep.WorstErrorMetres, sweep.WorstErrorDegrees) : Close(actual);
        bool isSuccess = metres <= _tolerance && degrees * (Math.PI / 180) <= _tolerance;
        return new MechanismResult(this, actual, isSuccess, $"{Figures.Number(metres)} m and {Figures.Number(degrees)} degrees are left");
    }

    private static (double Metres, double Degrees) Close(object? actual)
    {
        Mechanism mechanism = Tested.Mechanism(actual);
        DriveResult result = new PositionSolver(mechanism).Close(mechanism.NewState());
        return (result.ErrorMetres, result.ErrorDegrees);
    }
}
