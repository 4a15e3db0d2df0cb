using System;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Poses of a mechanism's bodies and its joint coordinates, angles unwrapped over turns. Copying allocates nothing.</summary>
public sealed class MechanismState
{
    internal MechanismState(Mechanism mechanism)
    {
        Mechanism = mechanism;
        Poses = new Pose[mechanism.BodyCount];
        Values = new double[mechanism.Coordinates.Count];
        Trail = new double[mechanism.Coordinates.Count];
    }

    /// <summary>Whose state this is.</summary>
    public Mechanism Mechanism { get; }

    /// <summary>World poses of the bodies' own frames.</summary>
    internal Pose[] Poses { get; }

    /// <summary>Coordinates as the joints' rows have them: radians or metres, not zeroed.</summary>
    internal double[] Values { get; }

    /// <summary>Values a step earlier on the way here: the direction of travel, which tells the branch where branches cross.</summary>
    internal double[] Trail { get; }

    /// <summary>A coordinate, degrees or metres.</summary>
    /// <param name="coordinate">Index into the mechanism's coordinates.</param>
    public double Coordinate(int coordinate) => Mechanism.Coordinates[coordinate].ToExternal(Values[coordinate]);

    /// <summary>World pose of a GameObject in Unity's frame.</summary>
    /// <param name="gameObject">Index of the GameObject.</param>
    public Pose Pose(int gameObject) => Mechanism.PoseOfGameObject(gameObject, Poses);

    /// <summary>Takes over another state of the same mechanism.</summary>
    public void CopyFrom(MechanismState other)
    {
        if (other is null)
            throw new ArgumentNullException(nameof(other));
        if (!ReferenceEquals(other.Mechanism, Mechanism))
            throw new ArgumentException("The state belongs to another mechanism.", nameof(other));
        Array.Copy(other.Poses, Poses, Poses.Length);
        Array.Copy(other.Values, Values, Values.Length);
        Array.Copy(other.Trail, Trail, Trail.Length);
    }

    /// <summary>A state of its own with the same poses.</summary>
    public MechanismState Clone()
    {
        var copy = new MechanismState(Mechanism);
        copy.CopyFrom(this);
        return copy;
    }
}
