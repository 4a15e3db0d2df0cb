namespace Kinefab.NUnit;

/// <summary>
/// Where a sentence about a motion begins. With <c>using static Kinefab.NUnit.MechanismConstraints;</c>
/// <code>
/// Assert.That(mechanism, Drives("Shaft").From(0).To(360).Moving("Slide").By(0.05).Within(1e-6));
/// Assert.That(mechanism, Closes.Within(1e-9));
/// Assert.That(scene, Keeps.Energy.Within(0.1).Percent.For(seconds: 10));
/// Assert.That(scene, Matches.Trajectory("lever.motion.json").Within(1e-6));
/// </code>
/// What is tested may be the path of a scene file, a <see cref="Validation.ValidScene"/> or a <see cref="Kinematics.Mechanism"/>.
/// </summary>
public static class MechanismConstraints
{
    /// <summary>All loops can be closed: <c>Closes.Within(1e-9)</c>.</summary>
    public static ClosesConstraint Closes => new();

    /// <summary>A coordinate can be driven through a range.</summary>
    /// <param name="coordinate">What the source calls the joint, or its GameObject's id, with the coordinate behind it where it has several: Arm.angularX.</param>
    /// <returns>The constraint: a whole turn from the exported pose unless stated otherwise.</returns>
    public static DrivesConstraint Drives(string coordinate) => new(coordinate);
}
