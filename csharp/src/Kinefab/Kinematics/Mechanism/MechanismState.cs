using System.Diagnostics;
using System;
using System.Text;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Poses of a mechanism's bodies and its joint coordinates, angles unwrapped over turns. Copying allocates nothing.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class MechanismState
{
    /// <summary>Of a mechanism, or of a part of it: the latter stays within the library.</summary>
    internal MechanismState(Mechanism mechanism, int bodies, int coordinates)
    {
        Mechanism = mechanism;
        Poses = new Pose[bodies];
        Values = new double[coordinates];
        Trail = new double[coordinates];
    }

    /// <summary>Whose state this is.</summary>
    public Mechanism Mechanism { get; }

    /// <summary>World poses of the bodies' own frames.</summary>
    internal Pose[] Poses { get; }

    /// <summary>Coordinates as the joints' rows have them: radians or metres, not zeroed.</summary>
    internal double[] Values { get; }

    /// <summary>Values a step earlier on the way here: the direction of travel, which tells the branch where branches cross.</summary>
    internal double[] Trail { get; }

    /// <summary>Stands, by the way on the trail, at a pose where branches cross.</summary>
    internal bool IsAtCrossing { get; set; }

    /// <summary>A coordinate by its name, degrees (over any number of turns) or metres, zero at the exported pose.</summary>
    /// <param name="name">Such as Slide or Lever/Crank:1.angle, see <see cref="Mechanism.TryFindCoordinate"/>.</param>
    /// <exception cref="ArgumentException">None answers to the name, or several do: the message says which there are.</exception>
    public double this[string name] => Coordinate(Mechanism.CoordinateNamed(name));

    /// <summary>A coordinate, degrees (over any number of turns) or metres, zero at the exported pose.</summary>
    /// <param name="coordinate">Index into the mechanism's coordinates.</param>
    /// <returns>Degrees or metres, left-handed sense.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such coordinate.</exception>
    public double Coordinate(int coordinate) => (uint)coordinate < (uint)Values.Length
        ? Mechanism.Coordinates[coordinate].ToExternal(Values[coordinate])
        : throw new ArgumentOutOfRangeException(nameof(coordinate), $"The mechanism has {Values.Length} coordinates.");

    /// <summary>The same as <see cref="this[string]"/>.</summary>
    /// <param name="name">Such as Slide or Lever/Crank:1.angle.</param>
    /// <returns>Degrees or metres, left-handed sense.</returns>
    /// <exception cref="ArgumentException">None answers to the name, or several do: the message says which there are.</exception>
    public double Coordinate(string name) => this[name];

    /// <summary>World pose of a GameObject in Unity's frame, metres.</summary>
    /// <param name="gameObject">Index of the GameObject.</param>
    /// <returns>Unity's left-handed frame, metres.</returns>
    /// <exception cref="ArgumentOutOfRangeException">There is no such GameObject.</exception>
    public Pose Pose(int gameObject) => Mechanism.PoseOfGameObject(gameObject, Poses);

    /// <summary>World pose of the GameObject with an id, or with a name that no other has; Unity's frame, metres.</summary>
    /// <param name="idOrName">Such as Lever/BarC:1 or BarC:1.</param>
    /// <returns>Unity's left-handed frame, metres.</returns>
    /// <exception cref="ArgumentException">None has it, or several have the name: the message says which there are.</exception>
    public Pose Pose(string idOrName) => Pose(Mechanism.GameObjectNamed(idOrName));

    /// <summary>
    /// Puts a body where a GameObject that it moves stands at a pose, and reads the coordinates of the body's joints anew:
    /// so a state follows a physics engine, or user input. The joints are as open as the poses leave them; see
    /// <see cref="PositionSolver.Close"/>.
    /// </summary>
    /// <param name="gameObject">Index of a GameObject that a Rigidbody moves.</param>
    /// <param name="world">Metres and a unit quaternion.</param>
    public void SetPose(int gameObject, in Pose world)
    {
        int body = Movable(gameObject, world);
        Poses[body] = Mechanism.PoseOfBody(gameObject, world);
        for (int i = 0; i < Values.Length; i++)
        {
            Joints.JointModel rows = Mechanism.Coordinates[i].JointRows;
            if (rows.Body0 == body || rows.Body1 == body)
                Read(i);
        }

        ForgetTrail();
    }

    /// <summary>As <see cref="SetPose"/> for several bodies, all coordinates being read once when they all stand there.</summary>
    /// <param name="gameObjects">Indices of GameObjects that Rigidbodies move.</param>
    /// <param name="worlds">A pose for each: metres and a unit quaternion.</param>
    public void SetPoses(ReadOnlySpan<int> gameObjects, ReadOnlySpan<Pose> worlds)
    {
        if (gameObjects.Length != worlds.Length)
            throw new ArgumentException("Each GameObject needs a pose.", nameof(worlds));
        for (int i = 0; i < worlds.Length; i++)
            Movable(gameObjects[i], worlds[i]);
        for (int i = 0; i < worlds.Length; i++)
            Poses[Mechanism.BodyOf(gameObjects[i])] = Mechanism.PoseOfBody(gameObjects[i], worlds[i]);
        for (int i = 0; i < Values.Length; i++)
            Read(i);
        ForgetTrail();
    }

    /// <summary>Takes over another state of the same mechanism.</summary>
    /// <param name="other">Left as it is.</param>
    public void CopyFrom(MechanismState other)
    {
        if (other is null)
            throw new ArgumentNullException(nameof(other));
        if (!ReferenceEquals(other.Mechanism, Mechanism))
            throw new ArgumentException("The state belongs to another mechanism.", nameof(other));
        Array.Copy(other.Poses, Poses, Poses.Length);
        Array.Copy(other.Values, Values, Values.Length);
        Array.Copy(other.Trail, Trail, Trail.Length);
        IsAtCrossing = other.IsAtCrossing;
    }

    /// <summary>How many numbers <see cref="CopyTo"/> writes.</summary>
    public int NumberCount => 7 * Poses.Length + 2 * Values.Length + 1;

    /// <summary>
    /// Writes the whole state, to be kept somewhere and read again by <see cref="CopyFrom(ReadOnlySpan{double})"/> for the same scene: after it
    /// every drive gives the same bits as if nothing had been written.
    /// </summary>
    /// <param name="numbers">At least <see cref="NumberCount"/> long.</param>
    /// <exception cref="ArgumentException">It is shorter.</exception>
    public void CopyTo(Span<double> numbers)
    {
        if (numbers.Length < NumberCount)
            throw new ArgumentException($"The state has {NumberCount} numbers.", nameof(numbers));
        int at = 0;
        foreach (Pose pose in Poses)
        {
            numbers[at++] = pose.Position.X;
            numbers[at++] = pose.Position.Y;
            numbers[at++] = pose.Position.Z;
            numbers[at++] = pose.Rotation.X;
            numbers[at++] = pose.Rotation.Y;
            numbers[at++] = pose.Rotation.Z;
            numbers[at++] = pose.Rotation.W;
        }

        Values.CopyTo(numbers.Slice(at));
        Trail.CopyTo(numbers.Slice(at + Values.Length));
        numbers[at + 2 * Values.Length] = IsAtCrossing ? 1 : 0;
    }

    /// <summary>Takes over what <see cref="CopyTo"/> wrote.</summary>
    /// <param name="numbers">All of them, and no more.</param>
    /// <exception cref="ArgumentException">They are of another mechanism, or not finite, or hold no poses: the state is as before.</exception>
    public void CopyFrom(ReadOnlySpan<double> numbers)
    {
        if (numbers.Length != NumberCount)
            throw new ArgumentException($"The state has {NumberCount} numbers.", nameof(numbers));
        for (int i = 0; i < numbers.Length; i++)
        {
            if (!Finite.Is(numbers[i]))
                throw new ArgumentException("Not finite.", nameof(numbers));
        }

        for (int i = 0; i < Poses.Length; i++)
        {
            ReadOnlySpan<double> q = numbers.Slice(7 * i + 3, 4);
            if (!(Math.Abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-4))
                throw new ArgumentException("A rotation is no unit quaternion.", nameof(numbers));
        }

        for (int i = 0; i < Poses.Length; i++)
        {
            ReadOnlySpan<double> n = numbers.Slice(7 * i, 7);
            Poses[i] = new Pose(new Vector3d(n[0], n[1], n[2]), new Quaterniond(n[3], n[4], n[5], n[6]));
        }

        int at = 7 * Poses.Length;
        numbers.Slice(at, Values.Length).CopyTo(Values);
        numbers.Slice(at + Values.Length, Values.Length).CopyTo(Trail);
        IsAtCrossing = numbers[at + 2 * Values.Length] != 0;
    }

    /// <summary>Forgets the way here: after it the state stands as if it had always stood there.</summary>
    internal void ForgetTrail()
    {
        Array.Copy(Values, Trail, Trail.Length);
        IsAtCrossing = false;
    }

    /// <summary>A state of its own with the same poses.</summary>
    /// <returns>Moving it leaves this one where it is.</returns>
    public MechanismState Clone()
    {
        var copy = new MechanismState(Mechanism, Poses.Length, Values.Length);
        copy.CopyFrom(this);
        return copy;
    }

    /// <summary>Every coordinate in one line, with units.</summary>
    public override string ToString()
    {
        const int most = 12;
        int moving = 0;
        var text = new StringBuilder();
        for (int i = 0; i < Values.Length; i++)
        {
            MechanismCoordinate coordinate = Mechanism.Coordinates[i];
            if (!coordinate.IsLocked && moving++ < most)
                text.Append(FormattableString.Invariant($"{(text.Length > 0 ? ", " : "")}{coordinate.Name} {Coordinate(i):0.######} {coordinate.Unit}"));
        }

        return moving > most ? $"{text}, and {moving - most} more" : moving > 0 ? text.ToString() : "nothing moves";
    }

    private int Movable(int gameObject, in Pose world)
    {
        int body = Mechanism.BodyOf(gameObject);
        if (body < 0)
            throw new ArgumentException("No Rigidbody moves this GameObject.", nameof(gameObject));
        if (!world.Position.IsFinite || !(Math.Abs(world.Rotation.LengthSquared - 1) < 1e-4))
            throw new ArgumentException("The pose is not finite, or its rotation no unit quaternion.", nameof(world));
        return body;
    }

    private void Read(int i)
    {
        MechanismCoordinate coordinate = Mechanism.Coordinates[i];
        Joints.JointModel rows = coordinate.JointRows;
        Values[i] = coordinate.Evaluate(Linkage.PoseOf(rows.Body0, Poses), Linkage.PoseOf(rows.Body1, Poses), Values[i], out _);
    }
}
