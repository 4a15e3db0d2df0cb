using NUnit.Framework;

namespace Kinefab.NUnit;

/// <summary><c>Has.Mobility(1)</c>.</summary>
public static class HasExtensions
{
    extension(Has)
    {
        /// <summary>Freedoms of finite motion, counted from the joints.</summary>
        /// <param name="freedoms">0 or more.</param>
        /// <returns>The constraint.</returns>
        public static MobilityConstraint Mobility(int freedoms) => new(freedoms);
    }
}
