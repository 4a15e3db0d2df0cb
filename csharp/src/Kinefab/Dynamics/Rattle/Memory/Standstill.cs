using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Remembers of an island the state at the start of a step in which nothing moved, where that came after another such: the next step that begins from
/// the same has the same answer, without a search. Compared are, to the bit, bodies, impulses, rows as their joints and paces of drives make them, what
/// angles are counted on from, and how often the step is halved; so that a changed force, target or limit lets the island go on at once. What else its
/// rows know of steps before is forgotten as it stands still.
/// </summary>
internal sealed class Standstill
{
    // Of a scalar row, see Write.
    private const int RowNumbers = 11;

    private double[] _state = Array.Empty<double>();
    private double[] _now = Array.Empty<double>();
    private bool _isKnown;

    /// <summary>Whether nothing moved in the last step, so that the next one's start is worth remembering.</summary>
    public bool HasStood { get; private set; }

    /// <summary>What was said of that step.</summary>
    public StepVerdict Verdict { get; private set; }

    /// <summary>Whether the loaded state is the one that is known to have no motion; else it is the one that a next <see cref="Remember"/> is about.</summary>
    /// <param name="batch">With rows read.</param>
    /// <param name="dt">Step, s.</param>
    /// <param name="halvings">Of the island's history.</param>
    public bool IsKnown(LaneBatch<ScalarLane> batch, double dt, int halvings)
    {
        if (!HasStood)
        {
            return false;
        }

        if (_now.Length == 0)
        {
            _now = new double[Length(batch.Shape)];
            _state = new double[_now.Length];
        }

        Write(batch, dt, halvings);
        if (_isKnown && _state.AsSpan().SequenceEqual(_now))
        {
            return true;
        }

        (_now, _state) = (_state, _now);
        _isKnown = false;
        return false;
    }

    /// <summary>A step was made in which nothing moved.</summary>
    public void Remember(in StepVerdict verdict)
    {
        _isKnown = HasStood;
        HasStood = true;
        Verdict = verdict;
    }

    /// <summary>A step was made.</summary>
    public void Forget()
    {
        HasStood = false;
        _isKnown = false;
    }

    private static int Length(Island island)
    {
        int numbers = 2 + BodyLanes.Count * island.Bodies.Length + island.RowCount + RowNumbers * island.ScalarCount;
        foreach (RowBlock block in island.Blocks)
        {
            numbers += block.Coupling?.Last.Length ?? 1;
        }

        return numbers;
    }

    private void Write(LaneBatch<ScalarLane> batch, double dt, int halvings)
    {
        int at = 0;
        Put(dt);
        Put(halvings);
        batch.Bodies.AsSpan(0, BodyLanes.Count * batch.Shape.Bodies.Length).CopyTo(_now.AsSpan(at));
        at += BodyLanes.Count * batch.Shape.Bodies.Length;
        batch.VelocityImpulses.CopyTo(_now, at);
        at += batch.VelocityImpulses.Length;
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            double[] last = batch.Couplings[n]?.Last ?? Array.Empty<double>();
            last.CopyTo(_now, at);
            at += last.Length;
            if (batch.Models[n] is { } joint)
            {
                Put(joint.LastTwist);
            }
        }

        for (int i = 0; i < batch.Shape.ScalarCount; i++)
        {
            ref readonly ScalarRow scalar = ref batch.Scalars!.Rows[i];
            ConstraintRow row = scalar.IsActive ? scalar.Built : default;
            bool isSpring = row.Has(RowFlags.Spring);
            bool bounces = row.Has(RowFlags.Restitution);
            Put(scalar.IsActive ? 1 : 0);
            Put((int)row.Flags);
            Put(row.GeometricError);
            Put(row.VelocityTarget);
            Put(row.Minimum);
            Put(row.Maximum);
            Put(isSpring || row.Has(RowFlags.Motion) ? row.Stiffness : 0);
            Put(isSpring ? row.Damping : 0);
            Put(bounces ? row.Restitution : 0);
            Put(bounces ? row.BounceThreshold : 0);
            Put(batch.Models[scalar.Block]!.DriveLimitsAreForces ? 1 : 0);
        }

        void Put(double number) => _now[at++] = number;
    }
}

/// <summary>What a step that was not solved in whole has to say.</summary>
internal readonly struct StepVerdict
{
    /// <summary>Parts that stood still.</summary>
    public int Stops { get; init; }

    /// <summary>The row that was farthest from closed, -1 where all were closed, and by how much, m or rad.</summary>
    public int Worst { get; init; }

    public double Error { get; init; }

    public StepTroubles Troubles { get; init; }
}
