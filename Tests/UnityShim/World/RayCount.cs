namespace UnityShim
{
    /// <summary>Counts the queries of scripts to the physics engine.</summary>
    public static class RayCount
    {
        /// <summary>The number of rays cast at single colliders. Tests reset it.</summary>
        public static int Rays { get; set; }
    }
}
