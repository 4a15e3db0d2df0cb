using System;
using Kinefab.Diagnostics;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <content>States that can be come back to, and told apart.</content>
public sealed partial class World
{
    // FNV-1a, 64 bits.
    private const ulong HashOfNothing = 14695981039346656037;
    private const ulong HashPrime = 1099511628211;

    /// <summary>
    /// Takes down the whole state: poses, velocities, forces, settings, drives, turns, broken joints, time, findings, and what the solver
    /// remembers. The motion goes on as if none had been taken.
    /// </summary>
    /// <returns>For <see cref="Restore"/> of this world, any number of times.</returns>
    /// <example><code>
    /// WorldSnapshot before = world.Snapshot();
    /// world.Run(2);
    /// world.Restore(before);   // the same calls now give the same bits again
    /// </code></example>
    public WorldSnapshot Snapshot()
    {
        var tape = new StateTape();
        Exchange(tape);
        return new WorldSnapshot(this, Time, tape);
    }

    /// <summary>Comes back to a state, as often as one likes: the same calls then give the same bits.</summary>
    /// <param name="snapshot">Taken of this very world.</param>
    /// <exception cref="ArgumentException">It is another world's.</exception>
    public void Restore(WorldSnapshot snapshot)
    {
        if (snapshot is null)
            throw new ArgumentNullException(nameof(snapshot));
        if (!ReferenceEquals(snapshot.Owner, this))
            throw new ArgumentException("The state belongs to another world.", nameof(snapshot));
        snapshot.Tape.Play();
        Exchange(snapshot.Tape);
    }

    /// <summary>
    /// One number for where everything is and how it moves: equal after the same calls on every runtime and processor, and but for one chance in
    /// 2^64 another as soon as a single bit of the state is. FNV-1a with 64 bits over the bytes of 13 doubles of each of <see cref="Bodies"/>, the
    /// lowest byte first: centre of mass x, y, z (m); rotation of the principal axes x, y, z, w; its velocity x, y, z (m/s); angular velocity
    /// x, y, z (rad/s), all in the world frame. Forces, settings and drives that are yet to act are not in it.
    /// </summary>
    /// <returns>The hash.</returns>
    /// <example><code>
    /// ulong first = World.Load("lever.kinefab").StateHash();
    /// ulong second = World.Load("lever.kinefab").StateHash();   // the same
    /// </code></example>
    public ulong StateHash()
    {
        ulong hash = HashOfNothing;
        for (int i = 0; i < Bodies.Count; i++)
        {
            Pose pose = _mechanism.Bodies.Poses[i];
            Add(ref hash, pose.Position);
            Add(ref hash, pose.Rotation.Vector);
            Add(ref hash, pose.Rotation.W);
            Add(ref hash, _mechanism.Bodies.LinearVelocities[i]);
            Add(ref hash, _mechanism.Bodies.AngularVelocities[i]);
        }

        return hash;
    }

    private static void Add(ref ulong hash, Vector3d value)
    {
        Add(ref hash, value.X);
        Add(ref hash, value.Y);
        Add(ref hash, value.Z);
    }

    private static void Add(ref ulong hash, double value)
    {
        ulong bits = (ulong)BitConverter.DoubleToInt64Bits(value);
        for (int i = 0; i < 8; i++)
            hash = unchecked((hash ^ (bits >> (8 * i) & 0xff)) * HashPrime);
    }

    private void Exchange(StateTape tape)
    {
        _mechanism.Exchange(tape);
        foreach (WorldBody body in Bodies)
            body.Exchange(tape);
        foreach (WorldJoint joint in Joints)
            joint.Exchange(tape);
        tape.Array(_broken);
        _exact.Exchange(tape);
        (double time, Report findings) = (Time, Findings);
        tape.Value(ref time);
        tape.Value(ref findings);
        (Time, Findings) = (time, findings);
        _solver.Exchange(tape);
    }
}
