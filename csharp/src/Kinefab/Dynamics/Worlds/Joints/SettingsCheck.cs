using System;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Validation;
using Document = Kinefab.Document;

namespace Kinefab.Dynamics;

/// <summary>Settings that a program gives a joint while it runs, held to the numbers that a file may state.</summary>
internal static class SettingsCheck
{
    /// <summary>Nothing is changed by settings that no file could have.</summary>
    /// <exception cref="ArgumentException">A number is out of its range or none; the message names the field.</exception>
    public static void ThrowIfWrong(Document.Joint settings)
    {
        var findings = new Findings(1);
        var at = new Place(findings, "settings");
        JointRules.Numbers(settings, at);
        if (settings is HingeJoint hinge)
        {
            HingeRules.Numbers(hinge, at);
            HingeRules.LimitsOrder(hinge, at);
        }
        else if (settings is ConfigurableJoint configurable)
        {
            ConfigurableRules.Numbers(configurable, at);
            ConfigurableRules.AngularXLimitsOrder(configurable, at);
            ConfigurableRules.SymmetricLimits(configurable, at);
            DriveRules.Numbers(configurable, at);
        }

        ThrowIfAny(findings, nameof(settings));
    }

    /// <inheritdoc cref="ThrowIfWrong(Document.Joint)"/>
    public static void ThrowIfWrong(ArticulationBody settings)
    {
        var findings = new Findings(1);
        var at = new Place(findings, "settings");
        LinkRules.Numbers(settings, at);
        LinkRules.Mass(settings, at);
        LinkRules.LimitsOrder(settings, at);
        ThrowIfAny(findings, nameof(settings));
    }

    /// <inheritdoc cref="ThrowIfWrong(Document.Joint)"/>
    public static void ThrowIfWrong(Rigidbody settings)
    {
        var findings = new Findings(1);
        var at = new Place(findings, "settings");
        BodyRules.Numbers(settings, at);
        BodyRules.Mass(settings, at);
        BodyRules.Inertia(settings, at);
        ThrowIfAny(findings, nameof(settings));
    }

    // Warnings are for files: a program may do as it likes.
    private static void ThrowIfAny(Findings findings, string argument)
    {
        if (findings.Errors > 0)
        {
            throw new ArgumentException(findings.List[0].Pointer + ": " + findings.List[0].Message, argument);
        }
    }
}
