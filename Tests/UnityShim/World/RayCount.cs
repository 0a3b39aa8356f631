namespace UnityShim
{
    /// <summary>Counts the queries of scripts to the physics engine.</summary>
    public static class RayCount
    {
        /// <summary>The number of rays cast at single colliders. Tests reset it.</summary>
        public static int Rays { get; set; }
    }

    /// <summary>Counts the searches of scripts for a kind of component.</summary>
    public static class ComponentSearchCount<T>
    {
        /// <summary>The number of calls of TryGetComponent. Tests reset it.</summary>
        public static int Searches { get; set; }
    }
}
