using NUnit.Framework.Constraints;

namespace Kinefab.NUnit;

/// <summary><c>Is.Not.ValidScene</c>, <c>Is.ValidScene.And.Mobility(1)</c>: the constraints behind <c>Not</c>, <c>And</c>, <c>Or</c> and <c>All</c>.</summary>
public static class ExpressionExtensions
{
    extension(ConstraintExpression expression)
    {
        /// <summary>A scene without errors. What is tested is the path of its file, or what <see cref="Document.SceneFile"/> read.</summary>
        public ValidSceneConstraint ValidScene => (ValidSceneConstraint)expression.Append(new ValidSceneConstraint());

        /// <summary>Freedoms of finite motion, counted from the joints.</summary>
        /// <param name="freedoms">0 or more.</param>
        /// <returns>The constraint.</returns>
        public MobilityConstraint Mobility(int freedoms) => (MobilityConstraint)expression.Append(new MobilityConstraint(freedoms));
    }
}
