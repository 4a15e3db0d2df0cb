using System;
using Kinefab.Diagnostics;

namespace Kinefab.Dynamics;

/// <content>States that can be come back to.</content>
public sealed partial class World
{
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
