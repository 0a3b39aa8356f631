#nullable enable
using HaptoFlow.Model;

namespace HaptoFlow
{
    /// <summary>The registration of one learnt material with an engine. Created on the main thread, run on
    /// another.</summary>
    internal sealed class MaterialRegistration
    {
        /// <summary>The engine assigns the index.</summary>
        public const int NewPlace = -1;

        private readonly string text;

        /// <param name="owner">The entry that the result belongs to.</param>
        /// <param name="place">Index of the material to replace, or <see cref="NewPlace"/>.</param>
        public MaterialRegistration(object owner, string text, int place) =>
            (Owner, Place, this.text) = (owner, place, text);

        public object Owner { get; }

        /// <summary>Index of the material in the engine; <see cref="NewPlace"/> where the engine refused a new
        /// one.</summary>
        public int Place { get; private set; }

        public double StiffnessNewtonsPerMetre { get; private set; }

        /// <summary>Why the engine refused the material; null where it did not.</summary>
        public string? Refusal { get; private set; }

        /// <summary>Says why a material of another space cannot be used with a model, and what to do.</summary>
        public static string ForeignSpace(string own, string models) =>
            $"it was learnt for another model (its space is {own}, the model's {models}). Learn it again from its " +
            "recording with this model, or choose the model that it was learnt for in Project Settings > HaptoFlow.";

        public void Do(HapticEngine engine, string space)
        {
            try
            {
                MaterialFile file = MaterialFile.Read(text);
                if (file.Space != space)
                {
                    Refusal = ForeignSpace(file.Space, space);
                    return;
                }
                StiffnessNewtonsPerMetre = file.StiffnessNewtonsPerMetre;
                if (Place == NewPlace)
                {
                    Place = engine.RegisterMaterial(text);
                }
                else
                {
                    engine.ReplaceMaterial(Place, text);
                }
            }
            catch (HaptoFlowException refusal)
            {
                Refusal = refusal.Message + ".";
            }
        }
    }
}
