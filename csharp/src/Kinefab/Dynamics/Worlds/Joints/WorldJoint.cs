using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Numerics;
using Document = Kinefab.Document;

namespace Kinefab.Dynamics;

/// <summary>A joint component in a <see cref="World"/>.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public abstract class WorldJoint
{
    private protected const double Degrees = 180 / Math.PI;

    private protected WorldJoint(MultibodySystem mechanism, int index, JointPlace place)
    {
        MultibodySystem = mechanism;
        Index = index;
        GameObject = place.GameObject;
        Component = place.Component;
        Id = place.Id;
    }

    /// <summary>Index of the GameObject that carries the joint.</summary>
    public int GameObject { get; }

    /// <summary>Index of the joint in that GameObject's components.</summary>
    public int Component { get; }

    /// <summary>Id of the GameObject that carries the joint; all joints of an object have it.</summary>
    public string Id { get; }

    /// <summary>
    /// What it is called in messages, on the command line and by <see cref="World.Joint"/>: the GameObject's id, Lever/Crank:1;
    /// with the component's index, Arm:2[3], where one object carries several joints.
    /// </summary>
    public string Name { get; internal set; } = "";

    /// <summary>The user's own name for it in the source; null: the file does not tell it.</summary>
    public string? NameInCad { get; internal set; }

    /// <summary>The coordinates that it left free or limited when the world was made.</summary>
    public abstract IReadOnlyList<Coordinate> FreeCoordinates { get; }

    /// <summary>Whether its constraint force or torque has passed a limit; a broken joint holds nothing any more.</summary>
    public bool IsBroken => Solved.IsBroken;

    /// <summary>
    /// Force of the constraint on actor 0 (the own body unless swapBodies; of a link's joint the link above) in the last step, N, world axes;
    /// drives and a link's joint friction do not count. In the step that breaks the joint the force that broke it, then none.
    /// </summary>
    public Vector3d CurrentForce => MultibodySystem.Reactions[Index].Force;

    /// <summary>Torque of the constraint on actor 0 about the connected anchor (of a link's joint its own) in the last step, N m, world axes; drives do not count.</summary>
    public Vector3d CurrentTorque => MultibodySystem.Reactions[Index].Torque;

    /// <summary>How far the joint's locked freedoms have come apart.</summary>
    public JointDrift Drift => JointDrift.Of(Solved, Pose0, Pose1);

    /// <summary>Whether a limit of the joint is reached or passed.</summary>
    public bool IsAtLimit => JointDrift.IsAtLimit(Solved, Pose0, Pose1);

    internal Kinefab.Joints.JointModel Solved => MultibodySystem.Joints[Index];

    internal int Index { get; }

    /// <summary>Hears what is asked of the joint that it cannot have; null: of a joint that only stands in for another one.</summary>
    internal Action<Diagnostic>? Tell { get; set; }

    /// <summary>Hears what settings a program gave the joint; null as above.</summary>
    internal Action<WorldJoint, Document.Joint>? Given { get; set; }

    /// <summary>JSON pointer of its component.</summary>
    internal string Pointer => FormattableString.Invariant($"/gameObjects/{GameObject}/components/{Component}");

    /// <summary>Actor 1's joint frame in actor 0's.</summary>
    internal Pose Relative => (Pose0 * Solved.Frame0).Inverse() * (Pose1 * Solved.Frame1);

    private protected MultibodySystem MultibodySystem { get; }

    private protected Pose Pose0 => MultibodySystem.Bodies.PoseOf(Solved.Body0);

    private protected Pose Pose1 => MultibodySystem.Bodies.PoseOf(Solved.Body1);

    /// <summary>
    /// A coordinate of the own body against the connected one, left-hand sense, 0 at start-up; degrees or metres. Of several free angles each is
    /// 2 atan2(q_i, q_w) of the relative rotation q: where another comes to half a turn both are near 0, it leaps, and says little.
    /// </summary>
    /// <param name="coordinate">Which of the joint's six motions.</param>
    /// <returns>Degrees, over any number of turns, or metres.</returns>
    /// <exception cref="ArgumentException">The joint has no such coordinate.</exception>
    public abstract double Coordinate(Coordinate coordinate);

    /// <summary>
    /// Drives a coordinate towards a value, with the component's own spring gains or, if it has none, firmly: the gap
    /// closes with a time constant of 0.1 s whatever loads the joint, with at most the force of the component's drive (0: any). The exact solver holds that
    /// motion as it holds a joint, and begins that to a goal far away, or to one that the mechanism does not follow, slowly; the other has a stiff spring
    /// follow it. Stands until Settings is set. A goal that limits, or the rest of the mechanism, keep it from is no error: what it came to is what
    /// <see cref="Coordinate"/> says after the run.
    /// </summary>
    /// <param name="coordinate">As in <see cref="Coordinate"/>.</param>
    /// <param name="target">
    /// Degrees (over any number of turns) or metres, zero at the start. Goals about several axes of a joint add up to one rotation. The angles about Y and Z
    /// have one drive, as in Unity: it holds the one that is not driven by itself. A slerp drive has all three: what drives one of them drives the others to
    /// their goals, or at their speeds, too, and <see cref="World.Findings"/> names what is given up.
    /// </param>
    /// <exception cref="ArgumentException">The joint has no such coordinate, or the target is no number.</exception>
    /// <example><code>
    /// WorldJoint wrist = world.Joint("Wrist");
    /// wrist.DriveTo(Coordinate.AngularX, 30);
    /// wrist.DriveTo(Coordinate.AngularY, 20);   // the first goal stays
    /// </code></example>
    public abstract void DriveTo(Coordinate coordinate, double target);

    /// <summary>
    /// Drives a coordinate at a speed, with at most the force of the component's drive or motor (0: any). Other coordinates keep their drives, but for
    /// a slerp drive's angles, as with <see cref="DriveTo"/>. Stands until Settings is set.
    /// </summary>
    /// <param name="coordinate">As in <see cref="Coordinate"/>.</param>
    /// <param name="speed">Degrees/s or metres/s.</param>
    /// <exception cref="ArgumentException">The joint has no such coordinate, or the speed is no number.</exception>
    public abstract void DriveAt(Coordinate coordinate, double speed);

    // The gap falls by a tenth each 0.01 s: prescribed in the exact solver; else by an overdamped spring, which yields by 1e-6 of the acceleration that
    // the load would give.
    private protected static Kinefab.Joints.DriveModel PositionDrive(in Kinefab.Joints.DriveModel given)
    {
        Kinefab.Joints.DriveModel drive = given.Stiffness > 0
            ? given
            : new Kinefab.Joints.DriveModel { Stiffness = 1e6, Damping = 1e5, IsAcceleration = true, Prescribes = Prescribed.Position };
        drive.ForceLimit = ForceLimit(given.ForceLimit);
        return drive;
    }

    // A motor's force is 0 where nobody stated one, and who drives a joint wants it to move.
    private protected static double ForceLimit(double own) => own > 0 ? own : double.PositiveInfinity;

    /// <summary>Called before a step where a program has given bodies other velocities: how fast its angles change now.</summary>
    internal virtual void NoteSpeeds()
    {
    }

    /// <summary>Called before a step: goals of drives follow the turns that were made.</summary>
    internal virtual void BeforeStep()
    {
    }

    /// <summary>
    /// Called when the joint has been moved by a step: notes its angles: as the solver counted them, else each the nearest to where it was and the
    /// way that its speeds lead.
    /// </summary>
    /// <param name="dt">Step, s.</param>
    /// <param name="endShare">How much of the way is the end speed's, the rest is the start speed's: all in symplectic Euler, half in a step of second order.</param>
    internal virtual void AfterStep(double dt, double endShare)
    {
    }

    /// <summary>What it remembers beside the joint that is solved.</summary>
    internal virtual void Exchange(StateTape tape)
    {
    }

    /// <summary>Its coordinates in degrees and metres, and what is wrong with it.</summary>
    public override string ToString()
    {
        string values = string.Concat(FreeCoordinates.Select(c => FormattableString.Invariant($", {c} {Coordinate(c):0.######} {(c is Document.Coordinate.X or Document.Coordinate.Y or Document.Coordinate.Z ? "m" : "deg")}")));
        return $"{GetType().Name.Substring("World".Length)} {Name}{(NameInCad is null ? "" : $" \"{NameInCad}\"")}{values}{(IsBroken ? ", broken" : IsAtLimit ? ", at a limit" : "")}";
    }
}

/// <summary>A FixedJoint in a <see cref="World"/>.</summary>
public sealed class WorldFixedJoint : WorldJoint
{
    internal WorldFixedJoint(MultibodySystem mechanism, int index, JointPlace place)
        : base(mechanism, index, place)
    {
    }

    /// <inheritdoc/>
    public override IReadOnlyList<Coordinate> FreeCoordinates => Array.Empty<Coordinate>();

    /// <inheritdoc/>
    public override double Coordinate(Coordinate coordinate) => throw NoCoordinates();

    /// <inheritdoc/>
    public override void DriveTo(Coordinate coordinate, double target) => throw NoCoordinates();

    /// <inheritdoc/>
    public override void DriveAt(Coordinate coordinate, double speed) => throw NoCoordinates();

    private static ArgumentException NoCoordinates() => new("A FixedJoint has no coordinates.");
}

/// <summary>Where a joint component stands in its scene.</summary>
internal readonly struct JointPlace
{
    public readonly int GameObject;
    public readonly int Component;
    public readonly string Id;

    public JointPlace(int gameObject, int component, string id)
    {
        GameObject = gameObject;
        Component = component;
        Id = id;
    }
}
