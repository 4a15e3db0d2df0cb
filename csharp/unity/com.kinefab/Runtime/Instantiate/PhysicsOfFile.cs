using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>What a file was exported with, for people.</summary>
    internal static class PhysicsOfFile
    {
        /// <summary>12 Rigidbodies and 14 joints.</summary>
        internal static string Describe(Doc.SceneDocument document)
        {
            int bodies = 0, links = 0, joints = 0;
            foreach (Doc.GameObject from in document.GameObjects)
            {
                foreach (Doc.Component component in from.Components)
                {
                    bodies += component is Doc.Rigidbody ? 1 : 0;
                    links += component is Doc.ArticulationBody ? 1 : 0;
                    joints += component is Doc.Joint ? 1 : 0;
                }
            }

            if (bodies + links == 0)
            {
                return "no bodies";
            }

            string told = bodies == 0 ? $"{links} ArticulationBodies" : links == 0 ? $"{bodies} Rigidbodies" : $"{links} ArticulationBodies, {bodies} Rigidbodies";
            return $"{told} and {joints} joint{(joints == 1 ? "" : "s")}";
        }
    }
}
